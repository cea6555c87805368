// A scene as it is shown: the values the renderer takes, and what clients are told of it, worked out once.
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "protocol/messages.h"
#include "renderer/scene/pose.h"
#include "renderer/scene/scene.h"

namespace lightwell {

/// Immutable, shared by sessions, the render thread and encoders.
class StagedScene {
 public:
  explicit StagedScene(Scene scene);

  /// Shares its ownership with the scene.
  const std::shared_ptr<const Scene>& scene() const { return scene_; }
  bool animated() const { return duration_s_ > 0.0; }
  protocol::SceneEntry entry(std::string name, bool builtin) const;

  /// The camera that `spec` asks for at a time; a problem with pointer `/camera/index` if the scene has none such.
  protocol::Decoded<PlacedCamera> place(const protocol::CameraSpec& spec, double time_s, float aspect_ratio) const;

  /// The box round the scene at rest.
  protocol::Bounds bounds() const;
  glm::vec3 center() const;

  /// Of all that its pictures depend on: the same for the same scene, on every server. Worked out by the first call.
  const std::string& digest() const;

  /// The lights as they stand at a time.
  std::vector<protocol::LightEntry> lights(double time_s) const;

 private:
  const Pose& rest() const;

  std::shared_ptr<const Scene> scene_;
  Scene rig_;  // without meshes: a pose of it costs next to nothing and has the same lights and cameras
  double duration_s_ = 0.0;
  mutable std::once_flag rest_made_;
  mutable Pose rest_;  // bounds alone
  mutable std::once_flag digest_made_;
  mutable std::string digest_;
};

}  // namespace lightwell
