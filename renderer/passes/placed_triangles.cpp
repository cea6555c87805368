#include "renderer/passes/placed_triangles.h"

#include <algorithm>
#include <cmath>

#include "renderer/passes/device_types.h"

namespace lightwell {

namespace {

using lanes::assign;

// As unit_from_octahedral() in shaders/packing.glsl.
glm::vec3 unpack_octahedral(std::uint32_t packed) {
  const auto number = [](std::uint32_t half) {
    return std::max(static_cast<float>(static_cast<std::int16_t>(half)) / 32767.0f, -1.0f);
  };
  const glm::vec2 octahedral(number(packed & 0xffffu), number(packed >> 16));
  glm::vec3 unit(octahedral, 1.0f - std::abs(octahedral.x) - std::abs(octahedral.y));
  const float fold = std::max(-unit.z, 0.0f);
  unit.x += unit.x >= 0.0f ? -fold : fold;
  unit.y += unit.y >= 0.0f ? -fold : fold;
  return glm::normalize(unit);
}

// What transform_normal() in shaders/scene_data.glsl does to a normal, before it is made a unit vector.
glm::mat3 normals_to_world(const DeviceInstance& instance) {
  const glm::vec3 r0(instance.world_from_object[0]), r1(instance.world_from_object[1]),
      r2(instance.world_from_object[2]);
  const float sign = (instance.flags & kDeviceInstanceMirrored) != 0 ? -1.0f : 1.0f;
  return sign * glm::transpose(glm::mat3(glm::cross(r1, r2), glm::cross(r2, r0), glm::cross(r0, r1)));
}

// As hit_point() in shaders/hit_surface.glsl, up to what depends on the ray and the place within the triangle.
lanes::HitSurface hit_surface(const DeviceScene::HostHitData& scene, std::uint32_t instance_index,
                              std::uint32_t triangle_index) {
  const DeviceInstance& instance = scene.instances[instance_index];
  const DeviceTriangle& triangle = scene.triangles[instance.first_triangle + triangle_index];
  const DeviceMaterial& material = scene.materials[instance.material];
  const glm::mat3 to_world = normals_to_world(instance);
  lanes::HitSurface surface;
  for (int corner = 0; corner < 3; ++corner)
    assign(surface.normals[corner], to_world * unpack_octahedral(triangle.normals[corner]));
  assign(surface.geometric_normal, glm::normalize(to_world * unpack_octahedral(triangle.geometric_normal)));
  assign(surface.base_color, glm::clamp(glm::vec3(material.base_color), 0.0f, 1.0f));
  surface.metallic = std::clamp(material.metallic, 0.0f, 1.0f);
  surface.roughness = material.roughness;
  surface.f0_dielectric = material.f0_dielectric;
  surface.specular_factor = material.specular_factor;
  assign(surface.emission, material.emission);
  surface.lit = (material.flags & kDeviceMaterialUnlit) != 0 ? 0.0f : 1.0f;
  surface.is_flat = triangle.normals[0] == triangle.normals[1] && triangle.normals[1] == triangle.normals[2];
  return surface;
}

}  // namespace

float side_of(const lanes::HitSurface& surface, glm::vec3 direction) {
  const float* normal = surface.geometric_normal;
  return glm::dot(glm::vec3(normal[0], normal[1], normal[2]), direction) > 0.0f ? -1.0f : 1.0f;
}

const PlacedTriangle& TriangleCache::at(std::uint32_t instance, std::uint32_t triangle) {
  constexpr std::uint32_t kStride = 397;  // so that instances of one mesh do not share places
  PlacedTriangle& placed = placed_[(triangle + instance * kStride) % kPlaces];
  if (placed.instance != instance || placed.triangle != triangle)
    placed = {instance, triangle, tracer_.corners_ws(instance, triangle), hit_surface(scene_, instance, triangle)};
  return placed;
}

std::unique_ptr<TriangleCache> TriangleCaches::take() {
  const std::scoped_lock lock(mutex_);
  if (idle_.empty()) return std::make_unique<TriangleCache>(scene_, tracer_);
  std::unique_ptr<TriangleCache> cache = std::move(idle_.back());
  idle_.pop_back();
  return cache;
}

void TriangleCaches::give_back(std::unique_ptr<TriangleCache> cache) {
  const std::scoped_lock lock(mutex_);
  idle_.push_back(std::move(cache));
}

}  // namespace lightwell
