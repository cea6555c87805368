// All images of a scene on the device, in arrays of four sizes, so that a shader can read any texture at any hit.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "renderer/gl/texture.h"
#include "renderer/scene/scene.h"

namespace lightwell {

/// Built for a scene's images and textures; immutable after. Images are resampled to the next of 128, 512, 1024 and
/// 2048 pixels a side (larger ones shrink), once per use as colour (sRGB) and as data (linear).
class SceneTextures {
 public:
  /// Uploads what the scene's materials use. Throws std::runtime_error when the device has no room.
  explicit SceneTextures(const Scene& scene);

  /// What `Material`'s shader struct stores: 0 for none, else array, layer and sampler in bits (shaders/textures.glsl).
  std::uint32_t slot(const TextureUse& use, bool srgb) const;

  /// Which of the sizes have a texture, a bit each.
  std::uint32_t size_classes(bool srgb) const;

  /// True if this was built for just these images and textures.
  bool fits(const Scene& scene) const;

  /// Binds all arrays to their units.
  void bind() const;

 private:
  struct Layer {
    int image;
    bool srgb;
    bool nearest;
    int size_class;
    int index;
  };
  int find_layer(int image, bool srgb, bool nearest) const;
  void collect(const Scene& scene);
  void upload(const Scene& scene);

  std::vector<std::shared_ptr<const Image>> images_;
  std::vector<Texture> textures_;
  std::vector<std::pair<int, int>> uses_;  // (texture, srgb) of all materials, to notice new uses after an edit
  std::vector<Layer> layers_;
  std::vector<gl::Texture> arrays_;  // sRGB classes, then linear ones; empty ones hold one black texel
};

}  // namespace lightwell
