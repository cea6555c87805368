#include "renderer/passes/scene_textures.h"

#include <algorithm>
#include <array>
#include <bit>

#include "renderer/passes/bindings.glsl"

namespace lightwell {

namespace {

constexpr std::array<int, TEXTURE_CLASSES> kClassSizePx = {128, 512, 1024, 2048};

int class_for(glm::ivec2 size_px) {
  const int longer = std::max(size_px.x, size_px.y);
  for (int i = 0; i < TEXTURE_CLASSES; ++i)
    if (longer <= kClassSizePx[static_cast<std::size_t>(i)]) return i;
  return TEXTURE_CLASSES - 1;
}

// The source texels that one target texel averages along one axis, as up to `kMostTaps` weights: a box when shrinking,
// linear interpolation when growing, the nearest texel when asked for.
struct Taps {
  int first = 0;
  std::vector<float> weights;
};

std::vector<Taps> resampling_taps(int from, int to, bool nearest) {
  std::vector<Taps> taps(static_cast<std::size_t>(to));
  const float scale = static_cast<float>(from) / static_cast<float>(to);
  for (int i = 0; i < to; ++i) {
    Taps& tap = taps[static_cast<std::size_t>(i)];
    const float center = (static_cast<float>(i) + 0.5f) * scale;
    if (nearest) {
      tap = {std::min(static_cast<int>(center), from - 1), {1.0f}};
    } else if (scale <= 1.0f) {
      const float left = std::clamp(center - 0.5f, 0.0f, static_cast<float>(from - 1));
      tap.first = std::min(static_cast<int>(left), std::max(from - 2, 0));
      const float right_weight = left - static_cast<float>(tap.first);
      tap.weights = from > 1 ? std::vector<float>{1.0f - right_weight, right_weight} : std::vector<float>{1.0f};
    } else {
      const int begin = static_cast<int>(static_cast<float>(i) * scale);
      const int end = std::clamp(static_cast<int>(static_cast<float>(i + 1) * scale), begin + 1, from);
      tap = {begin, std::vector<float>(static_cast<std::size_t>(end - begin), 1.0f / static_cast<float>(end - begin))};
    }
  }
  return taps;
}

std::vector<std::uint8_t> resample(const Image& image, int size_px, bool nearest) {
  const auto columns = resampling_taps(image.size_px.x, size_px, nearest);
  const auto rows = resampling_taps(image.size_px.y, size_px, nearest);
  const std::size_t width = static_cast<std::size_t>(size_px);
  const std::size_t height = static_cast<std::size_t>(image.size_px.y);
  std::vector<float> across(width * height * 4);
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x)
      for (std::size_t c = 0; c < 4; ++c) {
        float sum = 0.0f;
        for (std::size_t k = 0; k < columns[x].weights.size(); ++k) {
          const std::size_t column = static_cast<std::size_t>(columns[x].first) + k;
          sum += columns[x].weights[k] *
                 static_cast<float>(image.rgba[(y * static_cast<std::size_t>(image.size_px.x) + column) * 4 + c]);
        }
        across[(y * width + x) * 4 + c] = sum;
      }
  std::vector<std::uint8_t> out(width * width * 4);
  for (std::size_t y = 0; y < width; ++y)
    for (std::size_t x = 0; x < width * 4; ++x) {
      float sum = 0.5f;
      for (std::size_t k = 0; k < rows[y].weights.size(); ++k)
        sum += rows[y].weights[k] * across[(static_cast<std::size_t>(rows[y].first) + k) * width * 4 + x];
      out[y * width * 4 + x] = static_cast<std::uint8_t>(std::min(sum, 255.0f));
    }
  return out;
}

std::vector<std::pair<int, int>> texture_uses(const Scene& scene) {
  std::vector<std::pair<int, int>> uses;
  for (const Material& material : scene.materials) {
    const std::pair<int, int> all[] = {{material.base_color_texture.texture, 1},
                                       {material.emissive_texture.texture, 1},
                                       {material.metallic_roughness_texture.texture, 0},
                                       {material.normal_texture.texture, 0},
                                       {material.specular_texture.texture, 0},
                                       {material.specular_color_texture.texture, 1},
                                       {material.transmission_texture.texture, 0},
                                       {material.clearcoat_texture.texture, 0},
                                       {material.clearcoat_roughness_texture.texture, 0},
                                       {material.clearcoat_normal_texture.texture, 0},
                                       {material.sheen_color_texture.texture, 1},
                                       {material.sheen_roughness_texture.texture, 0}};
    for (const auto& use : all)
      if (use.first >= 0) uses.push_back(use);
  }
  std::sort(uses.begin(), uses.end());
  uses.erase(std::unique(uses.begin(), uses.end()), uses.end());
  return uses;
}

bool same_samplers(const std::vector<Texture>& a, const std::vector<Texture>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Texture& x, const Texture& y) {
    return x.image == y.image && x.sampler.mag_nearest == y.sampler.mag_nearest;
  });
}

}  // namespace

SceneTextures::SceneTextures(const Scene& scene)
    : images_(scene.images), textures_(scene.textures), uses_(texture_uses(scene)) {
  collect(scene);
  upload(scene);
}

void SceneTextures::collect(const Scene& scene) {
  for (const auto& [texture, srgb] : uses_) {
    const Texture& source = scene.textures[static_cast<std::size_t>(texture)];
    if (source.image < 0 || images_[static_cast<std::size_t>(source.image)]->rgba.empty()) continue;
    if (find_layer(source.image, srgb != 0, source.sampler.mag_nearest) >= 0) continue;
    const int size_class = class_for(images_[static_cast<std::size_t>(source.image)]->size_px);
    const bool is_srgb = srgb != 0;
    const auto same_array = [&](const Layer& l) { return l.size_class == size_class && l.srgb == is_srgb; };
    const auto index = static_cast<int>(std::count_if(layers_.begin(), layers_.end(), same_array));
    layers_.push_back({source.image, srgb != 0, source.sampler.mag_nearest, size_class, index});
  }
}

void SceneTextures::upload(const Scene& scene) {
  for (int array = 0; array < 2 * TEXTURE_CLASSES; ++array) {
    const bool srgb = array < TEXTURE_CLASSES;
    const int size_class = array % TEXTURE_CLASSES;
    const int size_px = kClassSizePx[static_cast<std::size_t>(size_class)];
    std::vector<const Layer*> members;
    for (const Layer& layer : layers_)
      if (layer.srgb == srgb && layer.size_class == size_class) members.push_back(&layer);
    gl::TextureOptions options{.target = GL_TEXTURE_2D_ARRAY};
    options.layers = std::max<int>(1, static_cast<int>(members.size()));
    options.min_filter = GL_LINEAR_MIPMAP_LINEAR;
    options.mag_filter = GL_LINEAR;
    options.wrap = GL_REPEAT;
    const int side = members.empty() ? 1 : size_px;
    options.levels = std::bit_width(static_cast<unsigned>(side));
    arrays_.emplace_back(srgb ? "colour textures" : "data textures", srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8,
                         glm::ivec2(side), options);
    for (const Layer* layer : members) {
      const auto pixels = resample(*scene.images[static_cast<std::size_t>(layer->image)], size_px, layer->nearest);
      glTextureSubImage3D(arrays_.back().id(), 0, 0, 0, layer->index, size_px, size_px, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                          pixels.data());
    }
    if (!members.empty()) glGenerateTextureMipmap(arrays_.back().id());
  }
}

int SceneTextures::find_layer(int image, bool srgb, bool nearest) const {
  for (std::size_t i = 0; i < layers_.size(); ++i)
    if (layers_[i].image == image && layers_[i].srgb == srgb && layers_[i].nearest == nearest)
      return static_cast<int>(i);
  return -1;
}

std::uint32_t SceneTextures::slot(const TextureUse& use, bool srgb) const {
  if (use.texture < 0) return 0;
  const Texture& texture = textures_[static_cast<std::size_t>(use.texture)];
  const int found = texture.image < 0 ? -1 : find_layer(texture.image, srgb, texture.sampler.mag_nearest);
  if (found < 0) return 0;
  const Layer& layer = layers_[static_cast<std::size_t>(found)];
  const Sampler& sampler = texture.sampler;
  const auto wrap_bits = [](Wrap wrap) { return wrap == Wrap::kRepeat ? 0u : wrap == Wrap::kMirroredRepeat ? 1u : 2u; };
  return 0x80000000u | static_cast<std::uint32_t>(layer.size_class + (srgb ? 0 : TEXTURE_CLASSES)) |
         static_cast<std::uint32_t>(layer.index) << 3 | wrap_bits(sampler.wrap_s) << 14 |
         wrap_bits(sampler.wrap_t) << 16 | (sampler.mag_nearest ? 1u << 18 : 0u) |
         (sampler.min_nearest ? 1u << 19 : 0u) | (sampler.mipmapped ? 1u << 20 : 0u) |
         (use.uv_set == 1 ? 1u << 21 : 0u);
}

std::uint32_t SceneTextures::size_classes(bool srgb) const {
  std::uint32_t classes = 0;
  for (const Layer& layer : layers_)
    if (layer.srgb == srgb) classes |= 1u << layer.size_class;
  return classes;
}

bool SceneTextures::fits(const Scene& scene) const {
  return images_ == scene.images && same_samplers(textures_, scene.textures) && uses_ == texture_uses(scene);
}

void SceneTextures::bind() const {
  for (std::size_t i = 0; i < arrays_.size(); ++i) arrays_[i].bind(static_cast<GLuint>(UNIT_TEXTURES_SRGB + i));
}

}  // namespace lightwell
