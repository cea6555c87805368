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
void place_surface(const DeviceTriangle& triangle, const DeviceMaterial& material, const glm::mat3& to_world,
                   lanes::HitSurface& surface) {
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
}

}  // namespace

float side_of(const lanes::HitSurface& surface, glm::vec3 direction) {
  const float* normal = surface.geometric_normal;
  return glm::dot(glm::vec3(normal[0], normal[1], normal[2]), direction) > 0.0f ? -1.0f : 1.0f;
}

const PlacedTriangle& TriangleCache::at(std::uint32_t instance, std::uint32_t triangle) {
  PlacedTriangle& placed = place(instance, triangle);
  if (!placed.has_corners) placed.corners_ws = tracer_.corners_ws(instance, triangle);
  placed.has_corners = true;
  return placed;
}

void TriangleCache::prefetch(std::uint32_t instance, std::uint32_t triangle) const {
  __builtin_prefetch(&scene_.triangles[scene_.instances[instance].first_triangle + triangle]);
  const char* to = reinterpret_cast<const char*>(&placed_[place_of(instance, triangle)]);
  for (std::size_t byte = 0; byte < sizeof(PlacedTriangle); byte += 64) __builtin_prefetch(to + byte, 1);
}

std::size_t TriangleCache::place_of(std::uint32_t instance, std::uint32_t triangle) {
  constexpr std::uint32_t kStride = 397;  // so that instances of one mesh do not share places
  return (triangle + instance * kStride) % kPlaces;
}

PlacedTriangle& TriangleCache::place(std::uint32_t instance_index, std::uint32_t triangle_index) {
  PlacedTriangle& placed = placed_[place_of(instance_index, triangle_index)];
  if (placed.instance == instance_index && placed.triangle == triangle_index) return placed;
  const DeviceInstance& instance = scene_.instances[instance_index];
  if (instance_index != last_instance_) normals_to_world_ = normals_to_world(instance);
  last_instance_ = instance_index;
  placed.instance = instance_index;
  placed.triangle = triangle_index;
  placed.has_corners = false;
  place_surface(scene_.triangles[instance.first_triangle + triangle_index], scene_.materials[instance.material],
                normals_to_world_, placed.surface);
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
