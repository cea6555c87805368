#include "renderer/scene/gltf/vertex_attributes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/scene/gltf/accessors.h"

namespace lightwell::gltf {
namespace {

/// Reads one attribute if the file has it.
template <class Element>
void read_attribute(const Context& context, const std::map<std::string, int>& attributes, const char* name,
                    std::size_t count, const std::string& where, std::vector<Element>& target,
                    bool keep_not_finite = false) {
  if (const int accessor = find_attribute(attributes, name); accessor != kNone)
    target = read_accessor<Element>(context, accessor, count, join(where, name), keep_not_finite);
}

/// COLOR_0 may have three or four components; without alpha it is opaque.
void read_colors(const Context& context, const tinygltf::Primitive& source, std::size_t count, const std::string& where,
                 std::vector<glm::vec4>& target) {
  const int accessor = find_attribute(source.attributes, "COLOR_0");
  if (accessor == kNone) return;
  const std::string path = join(where, "COLOR_0");
  if (find_accessor(context, accessor, path).type != TINYGLTF_TYPE_VEC3) {
    target = read_accessor<glm::vec4>(context, accessor, count, path);
    return;
  }
  target.reserve(count);
  for (const glm::vec3& color : read_accessor<glm::vec3>(context, accessor, count, path))
    target.emplace_back(color, 1.0f);
}

/// Joints and weights of four influences per vertex.
struct InfluenceSet {
  std::vector<std::uint32_t> joints;  // four per vertex
  std::vector<glm::vec4> weights;
};

struct Influence {
  std::uint32_t joint = 0;
  float weight = 0.0f;
};

constexpr std::size_t kPerSet = 4, kMostSets = 2;

std::vector<InfluenceSet> read_influence_sets(const Context& context, const tinygltf::Primitive& source,
                                              std::size_t count, const std::string& where) {
  std::vector<InfluenceSet> sets;
  for (std::size_t i = 0; i < kMostSets; ++i) {
    const std::string joints_name = "JOINTS_" + std::to_string(i), weights_name = "WEIGHTS_" + std::to_string(i);
    const int joints = find_attribute(source.attributes, joints_name);
    const int weights = find_attribute(source.attributes, weights_name);
    if (joints == kNone && weights == kNone) continue;
    if (joints == kNone || weights == kNone) fail(where, joints_name + " and " + weights_name + " must come together");
    sets.push_back({read_integers(context, joints, kPerSet, count, join(where, joints_name)),
                    read_accessor<glm::vec4>(context, weights, count, join(where, weights_name))});
  }
  return sets;
}

/// A vertex' influences, the strongest first; negative weights count as none.
std::array<Influence, kPerSet * kMostSets> influences_of(const std::vector<InfluenceSet>& sets, std::size_t vertex) {
  std::array<Influence, kPerSet * kMostSets> influences{};
  for (std::size_t s = 0; s < sets.size(); ++s)
    for (std::size_t i = 0; i < kPerSet; ++i)
      influences[kPerSet * s + i] = {sets[s].joints[kPerSet * vertex + i],
                                     std::max(sets[s].weights[vertex][static_cast<glm::length_t>(i)], 0.0f)};
  std::stable_sort(influences.begin(), influences.end(),
                   [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
  return influences;
}

/// Keeps the four strongest influences of each vertex and makes their weights sum to 1.
void read_skinning(Context& context, const tinygltf::Primitive& source, std::size_t count, const std::string& where,
                   Primitive& target) {
  const std::vector<InfluenceSet> sets = read_influence_sets(context, source, count, where);
  if (sets.empty()) return;
  bool some_without_weight = false, some_with_more = false;
  target.joints.assign(count, glm::uvec4(0));
  target.weights.assign(count, glm::vec4(0.0f));
  for (std::size_t v = 0; v < count; ++v) {
    const auto influences = influences_of(sets, v);
    double sum = 0.0;
    for (std::size_t i = 0; i < kPerSet; ++i) sum += influences[i].weight;
    some_with_more |= influences[kPerSet].weight > 0.0f;
    if (!(sum > 0.0)) {
      some_without_weight = true;
      target.joints[v].x = influences[0].joint;
      target.weights[v].x = 1.0f;
      continue;
    }
    for (glm::length_t i = 0; i < static_cast<glm::length_t>(kPerSet); ++i) {
      const Influence& influence = influences[static_cast<std::size_t>(i)];
      target.weights[v][i] = static_cast<float>(influence.weight / sum);
      target.joints[v][i] = influence.weight > 0.0f ? influence.joint : 0;
    }
  }
  if (some_without_weight) context.warnings.add(where, "vertices without any weight follow their first joint alone");
  if (some_with_more) context.warnings.add(where, "of more than four joints per vertex the strongest four are kept");
}

void read_morph_targets(Context& context, const tinygltf::Primitive& source, std::size_t count,
                        const std::string& where, Primitive& target) {
  for (std::size_t i = 0; i < source.targets.size(); ++i) {
    const std::map<std::string, int>& attributes = source.targets[i];
    const std::string path = join(join(where, "targets"), i);
    context.vertices.claim(count, path);
    MorphTarget& morph = target.morph_targets.emplace_back();
    read_attribute(context, attributes, "POSITION", count, path, morph.positions);
    read_attribute(context, attributes, "NORMAL", count, path, morph.normals);
    read_attribute(context, attributes, "TANGENT", count, path, morph.tangents);
    for (const auto& [name, accessor] : attributes)
      if (name != "POSITION" && name != "NORMAL" && name != "TANGENT")
        context.warnings.add_once(path, "morphing of " + in_quotes(name) + " is ignored");
  }
}

void warn_of_ignored(Context& context, const std::map<std::string, int>& attributes, const std::string& where) {
  constexpr std::array kKnown{"POSITION", "NORMAL",   "TANGENT",   "TEXCOORD_0", "TEXCOORD_1",
                              "COLOR_0",  "JOINTS_0", "WEIGHTS_0", "JOINTS_1",   "WEIGHTS_1"};
  for (const auto& [name, accessor] : attributes)
    if (!name.starts_with('_') && std::find(kKnown.begin(), kKnown.end(), name) == kKnown.end())
      context.warnings.add_once(where, "the vertex attribute " + in_quotes(name) + " is ignored");
}

}  // namespace

int find_attribute(const std::map<std::string, int>& attributes, const std::string& name) {
  const auto attribute = attributes.find(name);
  return attribute == attributes.end() ? kNone : attribute->second;
}

void read_vertices(Context& context, const tinygltf::Primitive& source, std::size_t vertex_count,
                   const std::string& where, Primitive& target) {
  const std::string path = join(where, "attributes");
  read_attribute(context, source.attributes, "POSITION", vertex_count, path, target.positions);
  read_attribute(context, source.attributes, "NORMAL", vertex_count, path, target.normals, true);
  read_attribute(context, source.attributes, "TANGENT", vertex_count, path, target.tangents, true);
  read_attribute(context, source.attributes, "TEXCOORD_0", vertex_count, path, target.uv0);
  read_attribute(context, source.attributes, "TEXCOORD_1", vertex_count, path, target.uv1);
  read_colors(context, source, vertex_count, path, target.colors);
  read_skinning(context, source, vertex_count, path, target);
  read_morph_targets(context, source, vertex_count, where, target);
  warn_of_ignored(context, source.attributes, path);
}

}  // namespace lightwell::gltf
