#include "renderer/passes/deformation_sources.h"

#include <algorithm>

#include "renderer/gl/texel_limit.h"
#include "renderer/passes/bindings.glsl"

namespace lightwell {

namespace {

std::vector<DeviceInfluence> influences_of(const Primitive& primitive) {
  std::vector<DeviceInfluence> influences(primitive.positions.size());  // of no joint: the vertex stays
  const std::size_t count = std::min({influences.size(), primitive.joints.size(), primitive.weights.size()});
  for (std::size_t i = 0; i < count; ++i)
    for (int k = 0; k < 4; ++k) {
      influences[i].joints[k] = primitive.joints[i][k];
      influences[i].weights[k] = primitive.weights[i][k];
    }
  return influences;
}

std::uint32_t append(const std::vector<glm::vec3>& values, std::size_t vertices, std::vector<glm::vec3>& all) {
  if (values.empty()) return DeformationSources::kNone;
  const auto first = static_cast<std::uint32_t>(all.size());
  all.insert(all.end(), values.begin(),
             values.begin() + static_cast<std::ptrdiff_t>(std::min(values.size(), vertices)));
  all.resize(first + vertices, glm::vec3(0.0f));
  return first;
}

}  // namespace

DeformationSources::DeformationSources(const std::vector<std::shared_ptr<const Primitive>>& primitives) {
  std::vector<DeviceInfluence> influences;
  std::vector<glm::vec3> displacements;
  for (const std::shared_ptr<const Primitive>& primitive : primitives) {
    Place& place = places_.emplace_back();
    if (!primitive->joints.empty() && !primitive->weights.empty()) {
      place.first_influence = static_cast<std::uint32_t>(influences.size());
      const std::vector<DeviceInfluence> own = influences_of(*primitive);
      influences.insert(influences.end(), own.begin(), own.end());
    }
    const std::size_t vertices = primitive->positions.size();
    for (const MorphTarget& target : primitive->morph_targets)
      place.targets.push_back({append(target.positions, vertices, displacements),
                               append(target.normals, vertices, displacements),
                               append(target.tangents, vertices, displacements)});
  }
  gl::check_texels(influences.size() * sizeof(DeviceInfluence), 16, "joints' influences");
  gl::check_texels(displacements.size() * sizeof(glm::vec3), sizeof(glm::vec3), "morph targets' displacements");
  influences_ = gl::Buffer("influences of joints", influences.size() * sizeof(DeviceInfluence));
  influences_.upload(std::span<const DeviceInfluence>(influences));
  displacements_ = gl::Buffer("displacements of morph targets", displacements.size() * sizeof(glm::vec3));
  displacements_.upload(std::span<const glm::vec3>(displacements));
  influence_texels_.attach(influences_);
  displacement_texels_.attach(displacements_);
}

void DeformationSources::bind() const {
  influence_texels_.bind(UNIT_INFLUENCES);
  displacement_texels_.bind(UNIT_DISPLACEMENTS);
}

}  // namespace lightwell
