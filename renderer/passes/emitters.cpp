#include "renderer/passes/emitters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "renderer/tracing/coverage.h"

namespace lightwell {

namespace {

double luminance(const glm::dvec3& color) {
  return glm::dot(color, glm::dvec3(0.2126, 0.7152, 0.0722));
}

double linear_from_srgb(std::uint8_t byte) {
  static const std::array<double, 256> table = [] {
    std::array<double, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double x = static_cast<double>(i) / 255.0;
      values[i] = x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
    }
    return values;
  }();
  return table[byte];
}

double texel_luminance(const Image& image, int x, int y) {
  const std::size_t first =
      4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.size_px.x) + static_cast<std::size_t>(x));
  return luminance({linear_from_srgb(image.rgba[first]), linear_from_srgb(image.rgba[first + 1]),
                    linear_from_srgb(image.rgba[first + 2])});
}

const Texture* texture_of(const Scene& scene, const TextureUse& use) {
  if (use.texture < 0) return nullptr;
  const Texture& texture = scene.textures[static_cast<std::size_t>(use.texture)];
  return texture.image >= 0 ? &texture : nullptr;
}

glm::vec2 transformed(const TextureUse& use, glm::vec2 uv) {
  const float c = std::cos(use.rotation), s = std::sin(use.rotation);
  const glm::vec2 scaled = use.scale * uv;
  return use.offset + glm::vec2(c * scaled.x + s * scaled.y, -s * scaled.x + c * scaled.y);
}

// The mean over points spread in the triangle. A bright spot between them is missed, so that a share of the whole
// texture's mean is added: what may emit is then never left out.
double triangle_luminance(const Texture& texture, const Image& image, const TextureUse& use,
                          const std::array<glm::vec2, 3>& uv, double texture_mean) {
  constexpr int kPoints = 32;
  double sum = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const float root = std::sqrt((static_cast<float>(i) + 0.5f) / kPoints);
    const float along = glm::fract(0.5f + static_cast<float>(i) * 0.618034f);
    const glm::vec2 at = transformed(use, (1.0f - root) * uv[0] + root * (1.0f - along) * uv[1] + root * along * uv[2]);
    sum += texel_luminance(image, nearest_texel(at.x, image.size_px.x, texture.sampler.wrap_s),
                           nearest_texel(at.y, image.size_px.y, texture.sampler.wrap_t));
  }
  return 0.9 * sum / kPoints + 0.1 * texture_mean;
}

}  // namespace

bool is_emitter(const Material& material) {
  const glm::vec3 radiance = material.emissive_factor * material.emissive_strength;
  return !material.unlit && material.alpha_mode == AlphaMode::kOpaque &&
         std::max(radiance.r, std::max(radiance.g, radiance.b)) > 0.0f;
}

double EmissiveTextures::mean_luminance(const Scene& scene, const TextureUse& use) {
  const Texture* texture = texture_of(scene, use);
  if (!texture) return 1.0;
  const std::shared_ptr<const Image>& image = scene.images[static_cast<std::size_t>(texture->image)];
  Entry& entry = means_[image.get()];
  if (entry.image.lock() == image) return entry.mean;
  double sum = 0.0;
  for (int y = 0; y < image->size_px.y; ++y)
    for (int x = 0; x < image->size_px.x; ++x) sum += texel_luminance(*image, x, y);
  entry = {image, sum / std::max(1.0, static_cast<double>(image->size_px.x) * image->size_px.y)};
  return entry.mean;
}

std::vector<Emitter> emitters_of(const Scene& scene, const Instance& instance, EmissiveTextures& textures) {
  const Material& material = scene.materials[static_cast<std::size_t>(instance.material)];
  const Primitive& primitive = *instance.primitive;
  const std::span<const glm::vec3> positions = positions_of(instance);
  const auto& uvs = material.emissive_texture.uv_set == 0 ? primitive.uv0 : primitive.uv1;
  const Texture* texture = texture_of(scene, material.emissive_texture);
  const double texture_mean = textures.mean_luminance(scene, material.emissive_texture);
  const glm::vec3 radiance = material.emissive_factor * material.emissive_strength;

  std::vector<Emitter> emitters(primitive.indices.size() / 3);
  for (std::size_t t = 0; t < emitters.size(); ++t) {
    const auto world = [&](std::size_t k) {
      return glm::vec3(instance.world_from_object * glm::vec4(positions[primitive.indices[3 * t + k]], 1.0f));
    };
    const auto uv = [&](std::size_t k) {
      const std::size_t vertex = primitive.indices[3 * t + k];
      return vertex < uvs.size() ? uvs[vertex] : glm::vec2(0.0f);
    };
    Emitter& emitter = emitters[t];
    emitter.corner = world(0);
    emitter.edge_u = world(1) - emitter.corner;
    emitter.edge_v = world(2) - emitter.corner;
    emitter.radiance = radiance;
    emitter.area_m2 = 0.5 * glm::length(glm::cross(glm::dvec3(emitter.edge_u), glm::dvec3(emitter.edge_v)));
    double shown = 1.0;
    if (texture)
      shown = triangle_luminance(*texture, *scene.images[static_cast<std::size_t>(texture->image)],
                                 material.emissive_texture, {uv(0), uv(1), uv(2)}, texture_mean);
    emitter.power = 2.0 * std::numbers::pi * emitter.area_m2 * luminance(radiance) * shown;
    if (!std::isfinite(emitter.power)) emitter.power = 0.0;
  }
  return emitters;
}

}  // namespace lightwell
