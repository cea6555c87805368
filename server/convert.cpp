#include "server/convert.h"

#include <algorithm>
#include <cmath>

#include "renderer/scene/gltf/edit.h"

namespace lightwell {
namespace {

using protocol::Problem;
using protocol::SettingsSpec;

Problem unprocessable(std::string pointer, std::string detail) {
  return protocol::make_problem(422, std::move(detail), std::move(pointer));
}

/// Puts names and numbers of a SettingsSpec into Settings; the first thing wrong is kept.
class SettingsReader {
 public:
  SettingsReader(const Settings& base, const std::string& pointer) : settings_(base), pointer_(pointer) {}

  void read(const SettingsSpec& spec) {
    read_name("method", spec.method, method_from_name, settings_.method);
    read_name("estimator", spec.estimator, estimator_from_name, settings_.estimator);
    read_name("view", spec.view, view_kind_from_name, settings_.view);
    read_name("tone_map", spec.tone_map, tone_map_from_name, settings_.tone_map);
    read_name("similarity", spec.similarity, similarity_from_name, settings_.similarity);
    read_value(spec.view_index, settings_.view_index);
    read_value(spec.patch, settings_.patch);
    read_value(spec.triangle_groups, settings_.triangle_groups);
    read_value(spec.normal_threshold, settings_.normal_threshold);
    read_value(spec.depth_threshold, settings_.depth_threshold);
    read_value(spec.trace_missed, settings_.trace_missed);
    read_value(spec.brute_force, settings_.brute_force);
    read_value(spec.samples, settings_.samples);
    read_bounces(spec.bounces);
    read_value(spec.indirect_size, settings_.indirect_size);
    read_value(spec.seed, settings_.seed);
    read_value(spec.shadow_size, settings_.shadow_size);
    read_value(spec.shadow_filter, settings_.shadow_filter);
    read_value(spec.denoise, settings_.denoise);
    read_value(spec.multiple_scattering, settings_.multiple_scattering);
    read_value(spec.temporal_antialiasing, settings_.temporal_antialiasing);
    read_value(spec.firefly_clamp, settings_.firefly_clamp);
    read_value(spec.hand_over, settings_.hand_over);
    read_value(spec.target_fps, settings_.target_fps);
    read_value(spec.warm_up, settings_.warm_up);
    if (spec.exposure_ev) {
      settings_.exposure_ev.reset();
      if (*spec.exposure_ev) settings_.exposure_ev = static_cast<float>(**spec.exposure_ev);
    }
    if (spec.background) {
      settings_.background.reset();
      if (const auto& color = *spec.background) settings_.background.emplace((*color)[0], (*color)[1], (*color)[2]);
    }
  }

  const Settings& settings() const { return settings_; }
  const std::optional<Problem>& problem() const { return problem_; }

 private:
  template <class T>
  void read_name(const char* member, const std::optional<std::string>& name,
                 std::optional<T> (*from_name)(std::string_view), T& out) {
    if (!name || problem_) return;
    if (const std::optional<T> value = from_name(*name))
      out = *value;
    else
      problem_ = unprocessable(pointer_ + "/" + member, "there is no " + std::string(member) + " \"" + *name + "\"");
  }

  void read_bounces(const std::optional<std::int32_t>& bounces) {
    if (!bounces || problem_) return;
    if (*bounces >= kUnlimitedBounces)
      problem_ = unprocessable(pointer_ + "/bounces",
                               "bounces is " + std::to_string(*bounces) + "; it may be at most 64, or \"inf\"");
    else
      settings_.bounces = *bounces == protocol::kEndlessBounces ? kUnlimitedBounces : *bounces;
  }

  template <class T, class Out>
  static void read_value(const std::optional<T>& given, Out& out) {
    if (given) out = static_cast<Out>(*given);
  }

  Settings settings_;
  const std::string& pointer_;
  std::optional<Problem> problem_;
};

/// "--indirect-size" is "/indirect_size" in JSON.
std::string member_of_option(std::string_view option) {
  option.remove_prefix(std::min(option.find_first_not_of('-'), option.size()));
  std::string member(option);
  std::replace(member.begin(), member.end(), '-', '_');
  if (member == "exposure") member = "exposure_ev";
  return member.empty() ? member : "/" + member;
}

}  // namespace

protocol::Decoded<Settings> with_spec(const Settings& base, const SettingsSpec& spec, glm::ivec2 size_px,
                                      const ServeLimits& limits, const std::string& pointer) {
  SettingsReader reader(base, pointer);
  reader.read(spec);
  if (reader.problem()) return *reader.problem();
  const Settings& settings = reader.settings();
  if (settings.samples > limits.max_samples)
    return unprocessable(pointer + "/samples", "samples is " + std::to_string(settings.samples) +
                                                   "; this server allows at most " +
                                                   std::to_string(limits.max_samples));
  if (const Status status = check_settings(settings, size_px); !status)
    return unprocessable(pointer + member_of_option(status.error().where), status.error().what);
  return settings;
}

std::optional<Problem> check_size(glm::ivec2 size_px, const ServeLimits& limits, const std::string& pointer) {
  const bool too_wide = size_px.x > limits.max_size_px;
  if (!too_wide && size_px.y <= limits.max_size_px) return {};
  return unprocessable(pointer + (too_wide ? "/width" : "/height"),
                       "a picture may have at most " + std::to_string(limits.max_size_px) + " pixels a side, not " +
                           std::to_string(too_wide ? size_px.x : size_px.y));
}

SettingsSpec spec_of(const Settings& settings) {
  SettingsSpec spec;
  spec.method = name_of(settings.method);
  spec.samples = settings.samples;
  spec.bounces = settings.bounces == kUnlimitedBounces ? protocol::kEndlessBounces : settings.bounces;
  spec.indirect_size = settings.indirect_size;
  spec.estimator = name_of(settings.estimator);
  spec.view = name_of(settings.view);
  spec.view_index = settings.view_index;
  spec.patch = settings.patch;
  spec.triangle_groups = settings.triangle_groups;
  spec.normal_threshold = settings.normal_threshold;
  spec.depth_threshold = settings.depth_threshold;
  spec.similarity = name_of(settings.similarity);
  spec.trace_missed = settings.trace_missed;
  spec.brute_force = settings.brute_force;
  spec.exposure_ev.emplace();
  if (settings.exposure_ev) spec.exposure_ev->emplace(*settings.exposure_ev);
  spec.tone_map = name_of(settings.tone_map);
  spec.seed = settings.seed;
  spec.background.emplace();
  if (settings.background) spec.background->emplace(vector_of(*settings.background));
  spec.shadow_size = settings.shadow_size;
  spec.shadow_filter = settings.shadow_filter;
  spec.denoise = settings.denoise;
  spec.multiple_scattering = settings.multiple_scattering;
  spec.temporal_antialiasing = settings.temporal_antialiasing;
  spec.firefly_clamp = settings.firefly_clamp;
  spec.hand_over = settings.hand_over;
  spec.target_fps = settings.target_fps;
  spec.warm_up = settings.warm_up;
  return spec;
}

Problem problem_of(const Error& error, std::string pointer) {
  switch (error.kind) {
    case ErrorKind::kInvalidInput:
    case ErrorKind::kUnsupported:
      return unprocessable(std::move(pointer), error.message());
    case ErrorKind::kNotFound:
      return protocol::make_problem(404, error.message(), std::move(pointer));
    case ErrorKind::kTooLarge:
      return protocol::make_problem(413, error.message(), std::move(pointer));
    case ErrorKind::kNoDevice:
    case ErrorKind::kDeviceLost:
      return protocol::make_problem(503, "the graphics device is not available");
    case ErrorKind::kUnwanted:
    case ErrorKind::kInternal:
      break;
  }
  return protocol::make_problem(500, "the picture could not be made");
}

protocol::Decoded<Scene> edited(const Scene& scene, const protocol::Edits& edits, const ServeLimits& limits) {
  Scene copy = scene;  // shares meshes and images
  std::size_t refused = edits.size();
  EditLimits edit_limits;
  edit_limits.max_triangles = limits.max_triangles;
  const Status status = apply_edits(copy, edits, edit_limits, &refused);
  if (status) return copy;
  if (status.error().kind == ErrorKind::kInternal) return problem_of(status.error());
  const std::string pointer = refused < edits.size() ? "/edits/" + std::to_string(refused) : "/edits";
  if (status.error().kind == ErrorKind::kTooLarge) return problem_of(status.error(), pointer);
  return unprocessable(pointer, status.error().message());
}

PlacedCamera placed(const protocol::FreeCamera& camera) {
  const glm::dvec3 eye(camera.eye[0], camera.eye[1], camera.eye[2]);
  const glm::dvec3 target(camera.target[0], camera.target[1], camera.target[2]);
  const double distance = glm::length(eye - target);
  const glm::dvec3 back = distance > 0.0 && std::isfinite(distance) ? (eye - target) / distance : glm::dvec3(0, 0, 1);
  const glm::dvec3 up = std::abs(back.y) < 0.9999 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, back.y > 0 ? -1 : 1);
  const glm::dvec3 right = glm::normalize(glm::cross(up, back));

  PlacedCamera result;
  result.camera.yfov = static_cast<float>(camera.yfov);
  // Near enough to look at small things closely, without wasting depth precision on large ones.
  result.camera.znear = static_cast<float>(camera.znear.value_or(std::clamp(distance * 0.01, 1e-4, 0.05)));
  result.world_from_view = glm::mat4(glm::dmat4(glm::dvec4(right, 0.0), glm::dvec4(glm::cross(back, right), 0.0),
                                                glm::dvec4(back, 0.0), glm::dvec4(eye, 1.0)));
  return result;
}

protocol::FreeCamera view_of(const PlacedCamera& camera, const glm::vec3& center) {
  const glm::vec3 eye(camera.world_from_view[3]);
  const glm::vec3 forward = -glm::vec3(camera.world_from_view[2]);
  const float distance = std::max(glm::dot(center - eye, forward), 0.25f * glm::length(center - eye));
  protocol::FreeCamera view;
  view.eye = vector_of(eye);
  view.target = vector_of(eye + forward * std::max(distance, 1e-2f));
  view.yfov = camera.camera.yfov;
  view.znear = camera.camera.znear;
  return view;
}

protocol::Vector3 vector_of(const glm::vec3& v) {
  return {v.x, v.y, v.z};
}

}  // namespace lightwell
