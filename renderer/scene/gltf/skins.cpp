#include "renderer/scene/gltf/skins.h"

#include <algorithm>
#include <optional>

#include "renderer/scene/gltf/accessors.h"

namespace lightwell::gltf {
namespace {

Skin read_skin(Context& context, const tinygltf::Skin& source, const std::string& where) {
  Skin skin;
  skin.name = source.name;
  if (source.joints.empty()) fail(join(where, "joints"), "there are none");
  for (const int joint : source.joints) at(context.document.model.nodes, joint, join(where, "joints"));
  skin.joints = source.joints;
  skin.joint_from_mesh.assign(skin.joints.size(), glm::mat4(1.0f));
  if (source.inverseBindMatrices == kNone) return skin;

  const std::string path = join(where, "inverseBindMatrices");
  const std::size_t count = find_accessor(context, source.inverseBindMatrices, path).count;
  context.animation_values.claim(16 * count, path);
  if (count < skin.joints.size())
    fail(path, std::to_string(count) + " matrices for " + std::to_string(skin.joints.size()) + " joints");
  skin.joint_from_mesh = read_accessor<glm::mat4>(context, source.inverseBindMatrices, count, path);
  skin.joint_from_mesh.resize(skin.joints.size());
  return skin;
}

/// One more than the highest joint that a vertex of the mesh follows: 0 if it follows none.
std::size_t joints_needed(const Mesh& mesh) {
  std::size_t needed = 0;
  for (const Primitive& primitive : mesh.primitives)
    for (const glm::uvec4& joints : primitive.joints)
      needed = std::max(needed, std::size_t{std::max({joints.x, joints.y, joints.z, joints.w})} + 1);
  return needed;
}

}  // namespace

void read_skins(Context& context, Scene& scene) {
  const std::vector<tinygltf::Skin>& skins = context.document.model.skins;
  for (std::size_t i = 0; i < skins.size(); ++i) scene.skins.push_back(read_skin(context, skins[i], join("skins", i)));
}

void check_skins(Context& context, Scene& scene) {
  std::vector<std::optional<std::size_t>> needed(scene.meshes.size());
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    Node& node = scene.nodes[i];
    if (node.skin == kNone) continue;
    const std::string where = join("nodes", i);
    const auto mesh = static_cast<std::size_t>(node.mesh);
    if (node.mesh != kNone && !needed[mesh]) needed[mesh] = joints_needed(*scene.meshes[mesh]);
    if (node.mesh == kNone || *needed[mesh] == 0) {
      context.warnings.add(where, "has a skin but no vertex with joints; the skin is ignored");
      node.skin = kNone;
      continue;
    }
    const Skin& skin = scene.skins[static_cast<std::size_t>(node.skin)];
    if (*needed[mesh] > skin.joints.size())
      fail(where, "a vertex follows joint " + std::to_string(*needed[mesh] - 1) + " of a skin with " +
                      std::to_string(skin.joints.size()));
  }
}

}  // namespace lightwell::gltf
