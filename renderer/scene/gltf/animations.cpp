#include "renderer/scene/gltf/animations.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "renderer/scene/gltf/accessors.h"

namespace lightwell::gltf {
namespace {

/// What a channel animates, and with how many numbers per key; nothing if it cannot be followed.
struct Target {
  AnimatedProperty property;
  int width;
};

std::optional<Target> find_target(Context& context, const Scene& scene, const tinygltf::AnimationChannel& source,
                                  const std::string& where) {
  // Of the file's nodes: those made of instances have no number there.
  const tinygltf::Node& node = at(context.document.model.nodes, source.target_node, join(where, "target/node"));
  const bool moves = source.target_path != "weights";
  if (moves && !node.matrix.empty()) {
    context.warnings.add(where, "moves a node that has a matrix; left out");
    return std::nullopt;
  }
  if (source.target_path == "translation") return Target{AnimatedProperty::kTranslation, 3};
  if (source.target_path == "rotation") return Target{AnimatedProperty::kRotation, 4};
  if (source.target_path == "scale") return Target{AnimatedProperty::kScale, 3};
  if (moves) {
    context.warnings.add(where, "animates " + in_quotes(source.target_path) + ", which is not supported; left out");
    return std::nullopt;
  }
  const std::size_t width = node.mesh == kNone ? 0 : scene.meshes[static_cast<std::size_t>(node.mesh)]->weights.size();
  if (width > 0) return Target{AnimatedProperty::kWeights, static_cast<int>(width)};
  context.warnings.add(where, "animates morph targets that do not exist; left out");
  return std::nullopt;
}

Interpolation read_interpolation(Context& context, const std::string& name, const std::string& where) {
  if (name == "STEP") return Interpolation::kStep;
  if (name == "CUBICSPLINE") return Interpolation::kCubicSpline;
  if (name != "LINEAR") context.warnings.add(where, "the interpolation " + in_quotes(name) + " is unknown; linear");
  return Interpolation::kLinear;
}

/// Removes keys that do not come after the one before, so that times ascend strictly.
void drop_keys_out_of_order(Context& context, std::size_t values_per_key, const std::string& where,
                            AnimationChannel& channel) {
  std::vector<float>&times = channel.times_s, &values = channel.values;
  std::size_t kept = 1;
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (!(times[i] > times[kept - 1])) continue;
    if (i != kept) {
      times[kept] = times[i];
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(i * values_per_key), values_per_key,
                  values.begin() + static_cast<std::ptrdiff_t>(kept * values_per_key));
    }
    ++kept;
  }
  if (kept == times.size()) return;
  context.warnings.add(where, std::to_string(times.size() - kept) + " keys not later than the one before are left out");
  times.resize(kept);
  values.resize(kept * values_per_key);
}

/// Quaternions at keys get unit length; the tangents of a spline keep theirs.
void normalise_rotations(Context& context, const std::string& where, AnimationChannel& channel) {
  const bool spline = channel.interpolation == Interpolation::kCubicSpline;
  const std::size_t stride = spline ? 12 : 4, first = spline ? 4 : 0;
  bool any_without_length = false;
  for (std::size_t i = first; i < channel.values.size(); i += stride) {
    float* q = &channel.values[i];
    const float length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    const bool usable = length > 1e-6f && std::isfinite(length);
    any_without_length |= !usable;
    for (int c = 0; c < 4; ++c) q[c] = usable ? q[c] / length : c == 3 ? 1.0f : 0.0f;
  }
  if (any_without_length) context.warnings.add(where, "rotations without length are replaced by none at all");
}

AnimationChannel read_channel(Context& context, const tinygltf::AnimationSampler& sampler, const Target& target,
                              int node, const std::string& where) {
  AnimationChannel channel;
  channel.node = node;
  channel.property = target.property;
  channel.width = target.width;
  channel.interpolation = read_interpolation(context, sampler.interpolation, where);

  const std::string input = join(where, "input"), output = join(where, "output");
  const std::size_t keys = find_accessor(context, sampler.input, input).count;
  const std::size_t per_key = channel.interpolation == Interpolation::kCubicSpline ? 3 : 1;
  const auto width = static_cast<std::size_t>(target.width);
  if (keys == 0) fail(input, "has no keys");
  // Below 2^31 times 3 times 2^31: no overflow.
  context.animation_values.claim(keys * (1 + per_key * width), where);
  channel.times_s = read_accessor<float>(context, sampler.input, keys, input);
  channel.values.resize(keys * per_key * width);
  // Weights come as scalars, all of one key after another.
  const bool scalars = target.property == AnimatedProperty::kWeights;
  const std::size_t elements = find_accessor(context, sampler.output, output).count;
  const std::size_t needed = scalars ? keys * per_key * width : keys * per_key;
  if (elements != needed)
    fail(output, "has " + std::to_string(elements) + " elements where " + std::to_string(needed) + " are needed");
  read_floats(context, sampler.output, scalars ? 1 : target.width, output, channel.values.data(), false);

  drop_keys_out_of_order(context, per_key * width, input, channel);
  if (target.property == AnimatedProperty::kRotation) normalise_rotations(context, output, channel);
  return channel;
}

}  // namespace

void read_animations(Context& context, Scene& scene) {
  const std::vector<tinygltf::Animation>& animations = context.document.model.animations;
  for (std::size_t i = 0; i < animations.size(); ++i) {
    const tinygltf::Animation& source = animations[i];
    const std::string where = join("animations", i);
    Animation& animation = scene.animations.emplace_back();
    animation.name = source.name;
    for (std::size_t c = 0; c < source.channels.size(); ++c) {
      const tinygltf::AnimationChannel& channel = source.channels[c];
      const std::string path = join(join(where, "channels"), c);
      const std::optional<Target> target = find_target(context, scene, channel, path);
      if (!target) continue;
      const tinygltf::AnimationSampler& sampler = at(source.samplers, channel.sampler, join(path, "sampler"));
      const std::string sampler_path = join(join(where, "samplers"), static_cast<std::size_t>(channel.sampler));
      animation.channels.push_back(read_channel(context, sampler, *target, channel.target_node, sampler_path));
      animation.duration_s = std::max(animation.duration_s, animation.channels.back().times_s.back());
    }
  }
}

}  // namespace lightwell::gltf
