// What skins and morph targets of a set of primitives are made from on the device, beside their rigid vertices:
// uploaded once, whatever moves.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "renderer/gl/buffer.h"
#include "renderer/gl/texture.h"
#include "renderer/scene/scene.h"

namespace lightwell {

/// A vertex's joints and what they weigh; two texels of uvec4.
struct DeviceInfluence {
  std::uint32_t joints[4];
  float weights[4];
};
static_assert(sizeof(DeviceInfluence) == 32);

class DeformationSources {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// Displacements of a morph target: the first of one for each vertex, or kNone where there are none.
  struct Target {
    std::uint32_t first_position = kNone, first_normal = kNone, first_tangent = kNone;
  };

  explicit DeformationSources(const std::vector<std::shared_ptr<const Primitive>>& primitives);

  /// Of the primitive with this number: its first DeviceInfluence, or kNone.
  std::uint32_t first_influence(std::size_t primitive) const { return places_[primitive].first_influence; }
  const std::vector<Target>& targets(std::size_t primitive) const { return places_[primitive].targets; }

  /// To UNIT_INFLUENCES and UNIT_DISPLACEMENTS.
  void bind() const;

 private:
  struct Place {
    std::uint32_t first_influence = kNone;
    std::vector<Target> targets;
  };
  std::vector<Place> places_;
  gl::Buffer influences_, displacements_;
  gl::BufferTexture influence_texels_{"influences of joints", GL_RGBA32UI};
  gl::BufferTexture displacement_texels_{"displacements of morph targets", GL_RGB32F};
};

}  // namespace lightwell
