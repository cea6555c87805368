#include "server/scenes/staged_scene.h"

#include <glm/gtc/type_ptr.hpp>

#include "server/convert.h"
#include "server/scenes/digest.h"

namespace lightwell {
namespace {

std::string_view name_of(LightKind kind) {
  switch (kind) {
    case LightKind::kDirectional:
      return "directional";
    case LightKind::kPoint:
      return "point";
    case LightKind::kSpot:
      return "spot";
  }
  return "point";
}

Scene rig_of(const Scene& scene) {
  Scene rig = scene;
  rig.meshes.clear();
  rig.images.clear();
  for (Node& node : rig.nodes) node.mesh = node.skin = -1;
  return rig;
}

}  // namespace

StagedScene::StagedScene(Scene scene)
    : scene_(std::make_shared<const Scene>(std::move(scene))),
      rig_(rig_of(*scene_)),
      duration_s_(animation_duration_s(*scene_)) {}

protocol::SceneEntry StagedScene::entry(std::string name, bool builtin) const {
  protocol::SceneEntry entry;
  entry.name = std::move(name);
  entry.builtin = builtin;
  entry.triangles = count_triangles(*scene_);
  entry.duration_s = duration_s_;
  entry.animated = animated();
  for (const PlacedCamera& camera : pose_at(rig_, 0.0).cameras) {
    const std::string& node_name = rig_.nodes[static_cast<std::size_t>(camera.node)].name;
    entry.cameras.push_back(camera.camera.name.empty() ? node_name : camera.camera.name);
  }
  return entry;
}

protocol::Decoded<PlacedCamera> StagedScene::place(const protocol::CameraSpec& spec, double time_s,
                                                   float aspect_ratio) const {
  if (const auto* free = std::get_if<protocol::FreeCamera>(&spec)) return placed(*free);
  const Pose pose = pose_at(rig_, time_s);
  if (const auto* own = std::get_if<protocol::SceneCamera>(&spec)) {
    if (own->index < pose.cameras.size()) return pose.cameras[own->index];
    return protocol::make_problem(
        422,
        "there is no camera " + std::to_string(own->index) + "; the scene has " + std::to_string(pose.cameras.size()),
        "/camera/index");
  }
  return pose.cameras.empty() ? frame_camera(rest(), aspect_ratio) : pose.cameras.front();
}

protocol::Bounds StagedScene::bounds() const {
  return {vector_of(rest().bounds_min), vector_of(rest().bounds_max)};
}

glm::vec3 StagedScene::center() const {
  return 0.5f * (rest().bounds_min + rest().bounds_max);
}

std::vector<protocol::LightEntry> StagedScene::lights(double time_s) const {
  const Pose pose = pose_at(rig_, time_s);
  if (pose.lights.empty()) return {};
  const std::vector<glm::mat4> world = world_from_nodes(rig_, time_s);
  std::vector<protocol::LightEntry> entries;
  for (const PlacedLight& light : pose.lights) {
    protocol::LightEntry& entry = entries.emplace_back();
    entry.index = static_cast<std::uint32_t>(light.index);
    entry.name = light.light.name;
    entry.kind = name_of(light.light.kind);
    entry.node = static_cast<std::uint32_t>(light.node);
    entry.position = vector_of(light.position_ws);
    entry.direction = vector_of(light.direction_ws);
    entry.color = vector_of(light.light.color);
    entry.intensity = light.light.intensity;
    const int parent = rig_.nodes[static_cast<std::size_t>(light.node)].parent;
    if (parent < 0) continue;
    const glm::mat4 parent_from_world = glm::inverse(world[static_cast<std::size_t>(parent)]);
    std::copy_n(glm::value_ptr(parent_from_world), 16, entry.parent_from_world.emplace().begin());
  }
  return entries;
}

const std::string& StagedScene::digest() const {
  std::call_once(digest_made_, [this] { digest_ = scene_digest(*scene_); });
  return digest_;
}

const Pose& StagedScene::rest() const {
  std::call_once(rest_made_, [this] {
    rest_ = pose_at(*scene_, 0.0);
    rest_.instances.clear();
  });
  return rest_;
}

}  // namespace lightwell
