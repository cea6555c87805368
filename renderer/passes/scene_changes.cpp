#include "renderer/passes/scene_changes.h"

#include <algorithm>
#include <cmath>

namespace lightwell {

namespace {

float greatest(const glm::vec3& v) {
  return std::max(v.x, std::max(v.y, v.z));
}

float relative_difference(const glm::vec3& a, const glm::vec3& b) {
  const float scale = std::max(greatest(glm::abs(a)), greatest(glm::abs(b)));
  return scale > 0.0f ? greatest(glm::abs(a - b)) / scale : 0.0f;
}

bool same_place(const PlacedLight& a, const PlacedLight& b) {
  return a.position_ws == b.position_ws && a.direction_ws == b.direction_ws;
}

float change_of(const std::vector<PlacedLight>& before, const std::vector<PlacedLight>& now) {
  if (before.size() != now.size()) return 1.0f;
  float change = 0.0f;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const Light &a = before[i].light, &b = now[i].light;
    const bool same_shape = a.kind == b.kind && a.range_m == b.range_m && a.inner_cone_angle == b.inner_cone_angle &&
                            a.outer_cone_angle == b.outer_cone_angle;
    change = std::max(change, same_shape ? relative_difference(a.color * a.intensity, b.color * b.intensity) : 1.0f);
  }
  return change;
}

float change_of(const Environment& a, const Environment& b) {
  if (a.image != b.image || a.rotation != b.rotation) return 1.0f;
  return std::max({relative_difference(a.zenith_radiance * a.strength, b.zenith_radiance * b.strength),
                   relative_difference(a.horizon_radiance * a.strength, b.horizon_radiance * b.strength),
                   relative_difference(a.ground_radiance * a.strength, b.ground_radiance * b.strength)});
}

glm::vec3 center_of(const SceneChanges::Placed& placed) {
  const Primitive& primitive = *placed.primitive;
  return glm::vec3(placed.world_from_object * glm::vec4(0.5f * (primitive.bounds_min + primitive.bounds_max), 1.0f));
}

// What moves by more than half its size at once was not on its way: where it was and where it is, the light is another.
float jump_of(const SceneChanges::Placed& before, const SceneChanges::Placed& now) {
  const glm::vec3 size =
      glm::vec3(glm::mat3(now.world_from_object) * (now.primitive->bounds_max - now.primitive->bounds_min));
  const float way_m = glm::distance(center_of(before), center_of(now));
  return glm::clamp(2.0f * way_m / std::max(glm::length(size), 1e-6f) - 1.0f, 0.0f, 1.0f);
}

float change_of(const std::vector<SceneChanges::Placed>& before, const std::vector<SceneChanges::Placed>& now) {
  if (before.size() != now.size()) return 1.0f;
  float change = 0.0f;
  for (std::size_t i = 0; i < now.size(); ++i)
    change = std::max(change, before[i].primitive == now[i].primitive ? jump_of(before[i], now[i]) : 1.0f);
  return change;
}

// All the light that bounces depends on every surface: how much, nobody knows beforehand.
float change_of(const std::vector<Material>& before, const std::vector<Material>& now) {
  return before == now ? 0.0f : 1.0f;
}

}  // namespace

bool SceneChanges::Placed::operator==(const Placed& other) const {
  return primitive == other.primitive && world_from_object == other.world_from_object &&
         same_shape(deformed, other.deformed) && material == other.material;
}

SceneChange SceneChanges::look_at(const Scene& scene, const Pose& pose) {
  State now{{}, pose.lights, scene.materials, scene.environment};
  now.instances.reserve(pose.instances.size());
  for (const Instance& instance : pose.instances)
    now.instances.push_back({instance.primitive, instance.world_from_object, instance.deformed, instance.material});
  SceneChange change;
  if (before_) {
    change.moving =
        before_->instances != now.instances ||
        !std::equal(before_->lights.begin(), before_->lights.end(), now.lights.begin(), now.lights.end(), same_place);
    change.light_share =
        std::max({change_of(before_->lights, now.lights), change_of(before_->environment, now.environment),
                  change_of(before_->materials, now.materials), change_of(before_->instances, now.instances)});
  }
  before_ = std::move(now);
  return change;
}

}  // namespace lightwell
