#include "renderer/passes/device_types.h"

#include <algorithm>
#include <cmath>

#include "renderer/passes/scene_textures.h"

namespace lightwell {

namespace {

// The octahedral map of shaders/packing.glsl.
std::uint32_t pack_octahedral(glm::vec3 unit) {
  const float sum = std::abs(unit.x) + std::abs(unit.y) + std::abs(unit.z);
  glm::vec2 p = glm::vec2(unit) / std::max(sum, 1e-20f);
  if (unit.z < 0.0f) {
    const glm::vec2 folded(1.0f - std::abs(p.y), 1.0f - std::abs(p.x));
    p = glm::vec2(std::copysign(folded.x, p.x), std::copysign(folded.y, p.y));
  }
  const auto snorm16 = [](float x) {
    return static_cast<std::uint32_t>(
        static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(std::clamp(x, -1.0f, 1.0f) * 32767.0f))));
  };
  return snorm16(p.x) | snorm16(p.y) << 16;
}

std::uint32_t pack_tangent(glm::vec4 tangent) {
  const std::uint32_t packed = pack_octahedral(glm::vec3(tangent));
  return tangent.w < 0.0f ? packed | 0x10000u : packed & ~0x10000u;
}

DeviceTextureUse pack_use(const TextureUse& use, bool srgb, const SceneTextures& textures) {
  DeviceTextureUse packed;
  packed.slot = textures.slot(use, srgb);
  // KHR_texture_transform: T * R * S on column vectors, with its rotation matrix [c s; -s c].
  const float c = std::cos(use.rotation), s = std::sin(use.rotation);
  packed.uv_transform = {c * use.scale.x, -s * use.scale.x, s * use.scale.y, c * use.scale.y};
  packed.uv_offset = use.offset;
  return packed;
}

// Reflectance at normal incidence, from air; KHR_materials_ior lets 0 stand for all of it.
float f0_of(float ior) {
  const float ratio = (ior - 1.0f) / (ior + 1.0f);
  return ratio * ratio;
}

// The coefficient by which Beer's law gives the colour at the distance: KHR_materials_volume. What a colour of 0 leaves
// is less than a float can tell from nothing.
glm::vec3 absorption_per_m(const Material& material) {
  if (!(material.attenuation_distance > 0.0f)) return glm::vec3(0.0f);
  return -glm::log(glm::max(material.attenuation_color, glm::vec3(1e-30f))) / material.attenuation_distance;
}

void pack_lobes(const Material& material, const SceneTextures& textures, DeviceMaterial& packed) {
  const float f0 = f0_of(material.ior);
  packed.f0_dielectric_color = glm::min(f0 * material.specular_color_factor, glm::vec3(1e6f));
  packed.transmission = material.transmission_factor;
  packed.sheen_color = material.sheen_color_factor;
  packed.sheen_roughness = material.sheen_roughness;
  packed.clearcoat = material.clearcoat_factor;
  packed.clearcoat_roughness = material.clearcoat_roughness;
  packed.clearcoat_normal_scale = material.clearcoat_normal_scale;
  const bool volume = material.thickness_factor > 0.0f && material.transmission_factor > 0.0f;
  packed.ior = volume ? std::max(material.ior, 1.0f) : 0.0f;
  packed.absorption = volume ? absorption_per_m(material) : glm::vec3(0.0f);
  packed.specular_texture = pack_use(material.specular_texture, false, textures);
  packed.specular_color_texture = pack_use(material.specular_color_texture, true, textures);
  packed.transmission_texture = pack_use(material.transmission_texture, false, textures);
  packed.clearcoat_texture = pack_use(material.clearcoat_texture, false, textures);
  packed.clearcoat_roughness_texture = pack_use(material.clearcoat_roughness_texture, false, textures);
  packed.clearcoat_normal_texture = pack_use(material.clearcoat_normal_texture, false, textures);
  packed.sheen_color_texture = pack_use(material.sheen_color_texture, true, textures);
  packed.sheen_roughness_texture = pack_use(material.sheen_roughness_texture, false, textures);
}

}  // namespace

std::vector<DeviceVertex> pack_vertices(const Primitive& primitive) {
  const std::vector<glm::vec3>& normals = primitive.normals;
  const std::vector<glm::vec4>& tangents = primitive.tangents;
  std::vector<DeviceVertex> packed(primitive.positions.size());
  for (std::size_t i = 0; i < packed.size(); ++i) {
    DeviceVertex& vertex = packed[i];
    vertex.normal = pack_octahedral(i < normals.size() ? normals[i] : glm::vec3(0, 1, 0));
    vertex.tangent = pack_tangent(i < tangents.size() ? tangents[i] : glm::vec4(1, 0, 0, 1));
    vertex.uv0 = i < primitive.uv0.size() ? primitive.uv0[i] : glm::vec2(0.0f);
    vertex.uv1 = i < primitive.uv1.size() ? primitive.uv1[i] : glm::vec2(0.0f);
    const glm::vec4 color = i < primitive.colors.size() ? primitive.colors[i] : glm::vec4(1.0f);
    for (int c = 0; c < 4; ++c)
      vertex.color[c] = static_cast<std::uint16_t>(std::lround(std::clamp(color[c], 0.0f, 1.0f) * 65535.0f));
  }
  return packed;
}

std::vector<DeviceTriangle> pack_triangles(const Primitive& primitive) {
  const std::vector<glm::vec3>& positions = primitive.positions;
  const std::vector<glm::vec3>& normals = primitive.normals;
  std::vector<DeviceTriangle> packed(primitive.indices.size() / 3);
  for (std::size_t t = 0; t < packed.size(); ++t) {
    DeviceTriangle& triangle = packed[t];
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.corners[k] = primitive.indices[3 * t + k];
      triangle.normals[k] = pack_octahedral(normals[triangle.corners[k]]);
    }
    const auto [a, b, c] = triangle.corners;
    const glm::vec3 area_normal = glm::cross(positions[b] - positions[a], positions[c] - positions[a]);
    const float area = glm::length(area_normal);
    triangle.geometric_normal = area > 0.0f ? pack_octahedral(area_normal / area) : triangle.normals[0];
    if (primitive.uv0.empty() || !(area > 0.0f)) continue;
    const glm::vec2 u = primitive.uv0[b] - primitive.uv0[a], v = primitive.uv0[c] - primitive.uv0[a];
    triangle.uv_per_m = std::sqrt(std::abs(u.x * v.y - u.y * v.x) / area);
  }
  return packed;
}

DeviceInstance pack_instance(const glm::mat4& world_from_object, std::uint32_t first_vertex,
                             std::uint32_t first_triangle, std::uint32_t material) {
  const glm::mat4 rows = glm::transpose(world_from_object);
  DeviceInstance packed{{rows[0], rows[1], rows[2]}, first_vertex, first_triangle, material, 0};
  if (glm::determinant(glm::mat3(world_from_object)) < 0.0f) packed.flags |= kDeviceInstanceMirrored;
  return packed;
}

DeviceInstanceBefore pack_instance_before(const glm::mat4& world_from_object) {
  const glm::mat4 rows = glm::transpose(world_from_object);
  return {{rows[0], rows[1], rows[2]}};
}

bool is_lambert(const Material& material) {
  return material.metallic_factor == 0.0f && material.specular_factor == 0.0f;
}

bool has_lobes(const Material& material) {
  return material.clearcoat_factor > 0.0f || material.sheen_color_factor != glm::vec3(0.0f) ||
         material.transmission_factor > 0.0f || material.specular_color_factor != glm::vec3(1.0f) ||
         material.specular_texture.texture >= 0 || material.specular_color_texture.texture >= 0;
}

bool is_clear(const Material& material) {
  constexpr float kClearRoughness = 0.1f;  // microfacets bend what passes a thin wall by about a degree
  return material.transmission_factor > 0.0f && material.roughness_factor <= kClearRoughness && !material.unlit;
}

bool is_clear_wall(const Material& material) {
  return is_clear(material) && !(material.thickness_factor > 0.0f);
}

DeviceMaterial pack_material(const Material& material, const SceneTextures& textures) {
  DeviceMaterial packed{};
  packed.base_color = material.base_color_factor;
  packed.emission = material.emissive_factor * material.emissive_strength;
  packed.normal_scale = material.normal_scale;
  packed.metallic = material.metallic_factor;
  packed.roughness = material.roughness_factor;
  const float f0 = f0_of(material.ior);
  packed.f0_dielectric = std::min(f0 * std::max({material.specular_color_factor.r, material.specular_color_factor.g,
                                                 material.specular_color_factor.b}),
                                  1.0f);
  packed.specular_factor = material.specular_factor;
  packed.flags = (material.alpha_mode == AlphaMode::kMask ? kDeviceMaterialMask : 0u) |
                 (material.alpha_mode == AlphaMode::kBlend ? kDeviceMaterialBlend : 0u) |
                 (material.double_sided ? kDeviceMaterialDoubleSided : 0u) |
                 (material.unlit ? kDeviceMaterialUnlit : 0u) | (is_clear(material) ? kDeviceMaterialClear : 0u) |
                 (is_clear_wall(material) ? kDeviceMaterialClearWall : 0u);
  packed.alpha_cutoff = material.alpha_cutoff;
  packed.base_color_texture = pack_use(material.base_color_texture, true, textures);
  packed.metallic_roughness_texture = pack_use(material.metallic_roughness_texture, false, textures);
  packed.normal_texture = pack_use(material.normal_texture, false, textures);
  packed.emissive_texture = pack_use(material.emissive_texture, true, textures);
  pack_lobes(material, textures, packed);
  return packed;
}

}  // namespace lightwell
