// Names and ranges of the settings, in one place for the command line and the API.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "renderer/renderer.h"

namespace lightwell {

namespace {

template <class Value, std::size_t N>
using Names = std::array<std::pair<Value, std::string_view>, N>;

constexpr Names<Method, 3> kMethods = {
    {{Method::kThesis, "thesis"}, {Method::kRealtime, "realtime"}, {Method::kReference, "reference"}}};
constexpr Names<Estimator, 2> kEstimators = {{{Estimator::kCorrected, "corrected"}, {Estimator::kLiteral, "literal"}}};
constexpr Names<Similarity, 2> kSimilarities = {
    {{Similarity::kCorrected, "corrected"}, {Similarity::kLiteral, "literal"}}};
constexpr Names<ViewKind, 21> kViews = {{{ViewKind::kFinal, "final"},
                                         {ViewKind::kDirect, "direct"},
                                         {ViewKind::kIndirect, "indirect"},
                                         {ViewKind::kAlbedo, "albedo"},
                                         {ViewKind::kNormal, "normal"},
                                         {ViewKind::kDepth, "depth"},
                                         {ViewKind::kOcclusionDistance, "occlusion-distance"},
                                         {ViewKind::kPosition, "position"},
                                         {ViewKind::kNormalDepth, "normal-depth"},
                                         {ViewKind::kBounce, "bounce"},
                                         {ViewKind::kDirection, "direction"},
                                         {ViewKind::kHitDistance, "hit-distance"},
                                         {ViewKind::kPatch, "patch"},
                                         {ViewKind::kReference, "reference-map"},
                                         {ViewKind::kCandidates, "candidates"},
                                         {ViewKind::kUnmatched, "unmatched"},
                                         {ViewKind::kHistory, "history"},
                                         {ViewKind::kVariance, "variance"},
                                         {ViewKind::kGradient, "gradient"},
                                         {ViewKind::kMotion, "motion"},
                                         {ViewKind::kCacheCells, "cache-cells"}}};
constexpr Names<LightStrategy, 3> kLightStrategies = {
    {{LightStrategy::kBoth, "both"}, {LightStrategy::kLights, "lights"}, {LightStrategy::kRays, "rays"}}};
constexpr Names<ToneMap, 2> kToneMaps = {{{ToneMap::kNeutral, "neutral"}, {ToneMap::kLinear, "linear"}}};

template <class Value, std::size_t N>
std::optional<Value> from_name(const Names<Value, N>& names, std::string_view name) {
  for (const auto& [value, known] : names)
    if (known == name) return value;
  return std::nullopt;
}

template <class Value, std::size_t N>
std::string_view to_name(const Names<Value, N>& names, Value value) {
  for (const auto& [known, name] : names)
    if (known == value) return name;
  return "unknown";
}

Status check_range(const char* name, int value, int least, int most) {
  if (value >= least && value <= most) return Done{};
  return invalid_input(
      name, std::to_string(value) + " is not within " + std::to_string(least) + " to " + std::to_string(most));
}

}  // namespace

bool every_method_shows(ViewKind view) {
  return view == ViewKind::kFinal || view == ViewKind::kDirect || view == ViewKind::kIndirect;
}

std::span<const ViewKind> all_view_kinds() {
  static const auto kinds = [] {
    std::array<ViewKind, kViews.size()> all{};
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = kViews[i].first;
    return all;
  }();
  return kinds;
}
std::optional<Method> method_from_name(std::string_view name) {
  return from_name(kMethods, name);
}
std::optional<Estimator> estimator_from_name(std::string_view name) {
  return from_name(kEstimators, name);
}
std::optional<Similarity> similarity_from_name(std::string_view name) {
  return from_name(kSimilarities, name);
}
std::optional<ViewKind> view_kind_from_name(std::string_view name) {
  return from_name(kViews, name);
}
std::optional<ToneMap> tone_map_from_name(std::string_view name) {
  return from_name(kToneMaps, name);
}
std::optional<LightStrategy> light_strategy_from_name(std::string_view name) {
  return from_name(kLightStrategies, name);
}
std::string_view name_of(Method method) {
  return to_name(kMethods, method);
}
std::string_view name_of(Estimator estimator) {
  return to_name(kEstimators, estimator);
}
std::string_view name_of(Similarity similarity) {
  return to_name(kSimilarities, similarity);
}
std::string_view name_of(ViewKind view) {
  return to_name(kViews, view);
}
std::string_view name_of(ToneMap tone_map) {
  return to_name(kToneMaps, tone_map);
}

std::string_view name_of(LightStrategy strategy) {
  return to_name(kLightStrategies, strategy);
}

// The patches and what is similar within them.
Status check_patches(const Settings& settings, glm::ivec2 size_px) {
  if (Status patch = check_range("patch", settings.patch, 1, 16); !patch) return patch;
  if (!std::has_single_bit(static_cast<unsigned>(settings.patch)))
    return invalid_input("patch", std::to_string(settings.patch) + " is not 1, 2, 4, 8 or 16");
  if (settings.patch > 1 && settings.patch > std::min({settings.indirect_size, size_px.x, size_px.y}))
    return invalid_input("patch", std::to_string(settings.patch) + " is larger than the picture");
  if (!(settings.normal_threshold >= -1.0f && settings.normal_threshold <= 1.0f))
    return invalid_input("normal-threshold", "it must be a cosine, from -1 to 1");
  if (!(settings.depth_threshold >= 0.0f && settings.depth_threshold <= 10.0f))
    return invalid_input("depth-threshold", "it must be from 0 to 10");
  return check_range("triangle-groups", settings.triangle_groups, 1, 64);
}

// What the view is of.
Status check_view(const Settings& settings) {
  if (settings.view == ViewKind::kBounce && (settings.view_index < 1 || settings.view_index > settings.bounces))
    return invalid_input("view-index", "there is no bounce " + std::to_string(settings.view_index) + " of " +
                                           std::to_string(settings.bounces));
  const bool of_realtime = settings.view >= ViewKind::kHistory;
  if (of_realtime && (settings.method != Method::kRealtime || settings.bounces == 0))
    return invalid_input(
        "view", "\"" + std::string(name_of(settings.view)) + "\" is of the method realtime, with one bounce or more");
  const bool of_direction = settings.view == ViewKind::kDirection || settings.view == ViewKind::kHitDistance ||
                            settings.view == ViewKind::kCandidates;
  if (of_direction && settings.view_index >= settings.samples)
    return invalid_input("view-index", "there is no direction " + std::to_string(settings.view_index) + " among " +
                                           std::to_string(settings.samples) + " from 0 on");
  return check_range("view-index", settings.view_index, 0, 4095);
}

Status check_settings(const Settings& settings, glm::ivec2 size_px) {
  const bool unlimited = settings.bounces == kUnlimitedBounces;
  if (unlimited && settings.method == Method::kThesis)
    return invalid_input("bounces", "inf is for the methods realtime and reference");
  const Status checks[] = {check_range("width", size_px.x, 1, 16384),
                           check_range("height", size_px.y, 1, 16384),
                           check_range("samples", settings.samples, 1, 4096),
                           check_range("bounces", unlimited ? 0 : settings.bounces, 0, 64),
                           check_range("indirect-size", settings.indirect_size, 8, 4096),
                           check_range("target-fps", settings.target_fps, 0, 240),
                           check_range("warm-up", settings.warm_up, 0, 64),
                           check_range("shadow-size", settings.shadow_size, 64, 4096),
                           check_range("shadow-filter", settings.shadow_filter, 1, 15),
                           check_patches(settings, size_px),
                           check_view(settings)};
  for (const Status& check : checks)
    if (!check) return check;
  if (settings.shadow_filter % 2 == 0)
    return invalid_input("shadow-filter", std::to_string(settings.shadow_filter) + " is not odd");
  if (!(settings.firefly_clamp >= 0.0f && settings.firefly_clamp <= kMostFireflyClamp))
    return invalid_input("firefly-clamp", "it must be from 0 to 1e6");
  if (settings.exposure_ev && !(std::abs(*settings.exposure_ev) <= 64.0f))
    return invalid_input("exposure", "it must be a number from -64 to 64");
  if (settings.background)
    for (int i = 0; i < 3; ++i)
      if (!((*settings.background)[i] >= 0.0f && (*settings.background)[i] <= 1e6f))
        return invalid_input("background", "its components must be from 0 to 1e6");
  return Done{};
}

}  // namespace lightwell
