// Which triangles of a pose emit light, and how much: what the light table is made of.
#pragma once

#include <memory>
#include <unordered_map>
#include <vector>

#include "renderer/scene/pose.h"

namespace lightwell {

/// A triangle that emits, world space. Both sides do, as every ray sees it.
struct Emitter {
  glm::vec3 corner{0.0f}, edge_u{0.0f}, edge_v{0.0f};
  glm::vec3 radiance{0.0f};  // nit; the material's, before its texture
  double area_m2 = 0.0;
  double power = 0.0;  // luminance of all its light: nit * m2 * steradian
};

/// Materials whose triangles are sampled as lights. Not those with holes, whose samples would be in the holes:
/// their light is found by the rays that hit them.
bool is_emitter(const Material& material);

/// Averages of emissive textures, kept while their images live.
class EmissiveTextures {
 public:
  /// Mean luminance of a texture's texels, linear: 1 without a texture.
  double mean_luminance(const Scene& scene, const TextureUse& use);

 private:
  struct Entry {
    std::weak_ptr<const Image> image;
    double mean = 1.0;
  };
  std::unordered_map<const Image*, Entry> means_;
};

/// One per triangle of the instance.
std::vector<Emitter> emitters_of(const Scene& scene, const Instance& instance, EmissiveTextures& textures);

}  // namespace lightwell
