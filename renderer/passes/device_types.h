// The structs of shaders/scene_data.glsl as C++ lays them out, and how scene values are packed into them.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "renderer/scene/pose.h"

namespace lightwell {

class SceneTextures;

struct DeviceVertex {
  std::uint32_t normal;   // octahedral, 2 x snorm16
  std::uint32_t tangent;  // the same; bit 16 set where the handedness is negative
  glm::vec2 uv0;
  glm::vec2 uv1;
  std::uint16_t color[4];  // unorm16
};
static_assert(sizeof(DeviceVertex) == 32);

/// What a hit needs to know of its triangle; object space.
struct DeviceTriangle {
  std::uint32_t normals[3];        // of the corners, octahedral
  std::uint32_t geometric_normal;  // by the winding
  std::uint32_t corners[3];        // vertices, relative to the instance's first
  float uv_per_m;                  // sqrt of the area in uv over the area in space
};
static_assert(sizeof(DeviceTriangle) == 32);

struct DeviceInstance {
  glm::vec4 world_from_object[3];  // rows
  std::uint32_t first_vertex;
  std::uint32_t first_triangle;
  std::uint32_t material;
  std::uint32_t flags;
};
static_assert(sizeof(DeviceInstance) == 64);
/// Where an instance was in the frame before: attributes of g_buffer.vert, of its motion variant alone.
struct DeviceInstanceBefore {
  glm::vec4 world_from_object[3];             // rows
  std::uint32_t first_position = 0xffffffff;  // of its deformed vertices before; all bits set: they are as they were
  std::uint32_t padding[3] = {};
};
static_assert(sizeof(DeviceInstanceBefore) == 64);

constexpr std::uint32_t kDeviceInstanceMirrored = 1;
constexpr std::uint32_t kDeviceMaterialMask = 1, kDeviceMaterialBlend = 2;
constexpr std::uint32_t kDeviceMaterialDoubleSided = 4, kDeviceMaterialUnlit = 8;
constexpr std::uint32_t kDeviceMaterialClear = 16, kDeviceMaterialClearWall = 32;

struct DeviceTextureUse {
  glm::vec4 uv_transform{1.0f, 0.0f, 0.0f, 1.0f};
  glm::vec2 uv_offset{0.0f};
  std::uint32_t slot = 0;
  std::uint32_t padding = 0;
};
static_assert(sizeof(DeviceTextureUse) == 32);

struct DeviceMaterial {
  glm::vec4 base_color;
  glm::vec3 emission;
  float normal_scale;
  float metallic;
  float roughness;
  float f0_dielectric;
  float specular_factor;
  std::uint32_t flags;
  float alpha_cutoff;
  std::uint32_t padding[2];
  DeviceTextureUse base_color_texture;
  DeviceTextureUse metallic_roughness_texture;
  DeviceTextureUse normal_texture;
  DeviceTextureUse emissive_texture;
  // What shaders/lobes.glsl reads.
  glm::vec3 f0_dielectric_color;
  float transmission;
  glm::vec3 sheen_color;
  float sheen_roughness;
  float clearcoat;
  float clearcoat_roughness;
  float clearcoat_normal_scale;
  float ior;             // of a volume; 0: thin-walled
  glm::vec3 absorption;  // of the volume, 1 / m
  float lobes_padding;
  DeviceTextureUse specular_texture;
  DeviceTextureUse specular_color_texture;
  DeviceTextureUse transmission_texture;
  DeviceTextureUse clearcoat_texture;
  DeviceTextureUse clearcoat_roughness_texture;
  DeviceTextureUse clearcoat_normal_texture;
  DeviceTextureUse sheen_color_texture;
  DeviceTextureUse sheen_roughness_texture;
};
static_assert(sizeof(DeviceMaterial) == 512);

std::vector<DeviceVertex> pack_vertices(const Primitive& primitive);
std::vector<DeviceTriangle> pack_triangles(const Primitive& primitive);
DeviceInstance pack_instance(const glm::mat4& world_from_object, std::uint32_t first_vertex,
                             std::uint32_t first_triangle, std::uint32_t material);
DeviceInstanceBefore pack_instance_before(const glm::mat4& world_from_object);
/// True if a material needs more than the plain BRDF.
bool has_lobes(const Material& material);

/// Whether its light is all reflected by the diffuse base: no metal, and nothing at the interface.
bool is_lambert(const Material& material);
/// Whether light goes straight on through it: transmission by a surface so smooth that it does not spread what it
/// passes. A volume's refraction is for those that follow its paths.
bool is_clear(const Material& material);
/// The same without a volume: the way of the light is straight in truth.
bool is_clear_wall(const Material& material);
DeviceMaterial pack_material(const Material& material, const SceneTextures& textures);

}  // namespace lightwell
