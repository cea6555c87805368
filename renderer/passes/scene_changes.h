// What changed in a view's scene since its last frame, as far as it matters to the light that earlier frames have
// found.
#pragma once

#include <optional>
#include <vector>

#include "renderer/scene/pose.h"

namespace lightwell {

struct SceneChange {
  bool moving = false;  // something: an instance, a light
  /// How much of the light has changed at once, [0, 1]: lamps that are switched, an environment or a material
  /// exchanged.
  float light_share = 0.0f;
};

/// Of the light of a frame ago, what is left over what is gone, for a share that has changed of (0, 1]: 0 after as
/// great a change as there is. What is remembered counts in proportion, so that where all lamps go out nothing is left
/// that an automatic exposure would find.
inline float left_over_gone(float light_share) {
  return (1.0f - light_share) / light_share;
}

class SceneChanges {
 public:
  /// An instance, as far as it is compared.
  struct Placed {
    std::shared_ptr<const Primitive> primitive;
    glm::mat4 world_from_object;
    std::shared_ptr<const DeformedShape> deformed;
    int material;
    bool operator==(const Placed& other) const;
  };

  /// What is different from the scene of the last call.
  SceneChange look_at(const Scene& scene, const Pose& pose);

 private:
  struct State {
    std::vector<Placed> instances;
    std::vector<PlacedLight> lights;
    std::vector<Material> materials;
    Environment environment;
  };
  std::optional<State> before_;
};

}  // namespace lightwell
