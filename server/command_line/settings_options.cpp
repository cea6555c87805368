#include "server/command_line/settings_options.h"

#include <fmt/format.h>

#include <bit>
#include <limits>

#include "server/command_line/add_option.h"

namespace lightwell {

namespace {

Result<int> parse_shadow_filter(const std::string& text) {
  const Result<long long> width = parse_integer(text, 1, 15);
  if (!width || *width % 2 == 0) return invalid_input("", "expected an odd integer from 1 to 15, not \"" + text + "\"");
  return static_cast<int>(*width);
}

Result<int> parse_patch(const std::string& text) {
  const Result<long long> side = parse_integer(text, 1, 16);
  if (!side || !std::has_single_bit(static_cast<unsigned long long>(*side)))
    return invalid_input("", "expected 1, 2, 4, 8 or 16, not \"" + text + "\"");
  return static_cast<int>(*side);
}

Result<float> parse_float(const std::string& text, double least, double most) {
  const Result<double> number = parse_number(text, least, most);
  if (!number) return number.error();
  return static_cast<float>(*number);
}
Result<float> parse_cosine(const std::string& text) {
  return parse_float(text, -1.0, 1.0);
}
Result<float> parse_depth_threshold(const std::string& text) {
  return parse_float(text, 0.0, 10.0);
}

Result<float> parse_firefly_clamp(const std::string& text) {
  return parse_float(text, 0.0, kMostFireflyClamp);
}

Result<int> parse_bounces(const std::string& text) {
  if (text == "inf") return kUnlimitedBounces;
  const Result<long long> bounces = parse_integer(text, 0, 64);
  if (!bounces) return invalid_input("", "expected an integer from 0 to 64 or inf, not \"" + text + "\"");
  return static_cast<int>(*bounces);
}

Result<std::optional<float>> parse_exposure(const std::string& text) {
  if (text == "auto") return std::optional<float>();
  const Result<double> stops = parse_number(text, -64.0, 64.0);
  if (!stops) return invalid_input("", "expected stops from -64 to 64 or auto, not \"" + text + "\"");
  return std::optional<float>(static_cast<float>(*stops));
}

Result<std::string> parse_tracer(const std::string& text) {
  if (text == "embree" || text == "compute" || text == "brute-force") return text;
  return invalid_input("", "expected embree, compute or brute-force, not \"" + text + "\"");
}

void add_transport_options(CLI::App& app, Settings& settings) {
  add_named(app, "--method", settings.method, {Method::kThesis, Method::kRealtime, Method::kReference},
            method_from_name, "How light is found");
  add_integer(app, "--samples", settings.samples, 1, 4096,
              "Directions per pixel of the indirect map; realtime spreads them over 16 frames, with 8 and 4 patches of "
              "two and four "
              "pixels share a ray");
  add_integer(app, "--indirect-size", settings.indirect_size, 8, 4096,
              "The longer side of the map in which indirect light is found, in pixels");
  add_thesis_options(app, settings);
  add_named(app, "--light-strategy", settings.light_strategy,
            {LightStrategy::kBoth, LightStrategy::kLights, LightStrategy::kRays}, light_strategy_from_name,
            "How reference finds lights that have a size: by samples of them, by rays that hit them, or by both");
  app.add_flag("--photon-guides,!--no-photon-guides", settings.photon_guides,
               "reference: photons tell paths where mirrors throw light from; without them caustics are noisier");
}

void add_display_options(CLI::App& app, Settings& settings) {
  add_named(app, "--view", settings.view, all_view_kinds(), view_kind_from_name, "What the picture shows");
  add_integer(
      app, "--view-index", settings.view_index, 0, 4095,
      "Which direction (from 0) or bounce (from 1) the views direction, hit-distance, candidates and bounce show");
  add_parsed(app, "--exposure", settings.exposure_ev, parse_exposure, "EV",
             "Exposure in stops: light is scaled by 2^EV; auto follows the median luminance", "auto");
  add_named(app, "--tone-map", settings.tone_map, {ToneMap::kNeutral, ToneMap::kLinear}, tone_map_from_name,
            "The curve from light to display");
  add_parsed(
      app, "--background", settings.background,
      [](const std::string& text) -> Result<std::optional<glm::vec3>> {
        const Result<glm::vec3> color = parse_color(text);
        if (!color) return color.error();
        return std::optional<glm::vec3>(*color);
      },
      "R,G,B", "Light behind everything the camera sees, linear, in nit; without it the scene's environment");
}

}  // namespace

void add_thesis_options(CLI::App& app, Settings& settings) {
  add_parsed(app, "--bounces", settings.bounces, parse_bounces, "N",
             "0: direct light only, 1: the first bounce, ... 64; inf: no limit, with the methods realtime (which knows "
             "none from 3 on) and reference",
             std::to_string(settings.bounces));
  add_named(app, "--estimator", settings.estimator, {Estimator::kCorrected, Estimator::kLiteral}, estimator_from_name,
            "The thesis' sum over directions: unbiased, or to the letter");
  add_parsed(app, "--patch", settings.patch, parse_patch, "N",
             "Side of the patches of pixels that share directions and candidates: 1, 2, 4, 8 or 16",
             std::to_string(settings.patch));
  add_integer(app, "--triangle-groups", settings.triangle_groups, 1, 64,
              "Groups of triangles, the nearest of each of which is a patch's candidate");
  add_parsed(app, "--normal-threshold", settings.normal_threshold, parse_cosine, "COSINE",
             "Pixels are similar where the cosine between their normals is greater",
             fmt::format("{}", settings.normal_threshold));
  add_parsed(app, "--depth-threshold", settings.depth_threshold, parse_depth_threshold, "SHARE",
             "Pixels are similar where their depths differ by less, as a share of the greater",
             fmt::format("{}", settings.depth_threshold));
  add_named(app, "--similarity", settings.similarity, {Similarity::kCorrected, Similarity::kLiteral},
            similarity_from_name, "Depths that differ by less are similar, or, as the thesis prints it, by more");
  app.add_flag("--trace-missed,!--no-trace-missed", settings.trace_missed,
               "Trace a ray anew that none of its patch's candidates lies before");
  app.add_flag(
      "--brute-force,!--no-brute-force", settings.brute_force,
      "thesis: rays try every triangle, up to 4e8 tests a frame on a software device; --tracer brute-force knows "
      "no limit");
  add_integer(app, "--shadow-size", settings.shadow_size, 64, 4096, "A shadow map's side in pixels");
  add_parsed(app, "--shadow-filter", settings.shadow_filter, parse_shadow_filter, "N",
             "Width of the shadow maps' filter in pixels, odd", std::to_string(settings.shadow_filter));
  app.add_flag("--denoise,!--no-denoise", settings.denoise,
               "thesis: smooth the indirect light within surfaces; realtime always does");
  app.add_flag("--multiple-scattering,!--no-multiple-scattering", settings.multiple_scattering,
               "Keep the light that bounces between the microfacets of rough surfaces");
  app.add_flag("--temporal-antialiasing,!--no-temporal-antialiasing", settings.temporal_antialiasing,
               "Smooth realtime's edges over its frames, along with what moves");
  add_parsed(
      app, "--firefly-clamp", settings.firefly_clamp, parse_firefly_clamp, "TIMES",
      "realtime: what one sample brings of light that has bounced is at most so many times what samples bring in "
      "the mean, 10 to 100 where specks are to go; takes light away, --json tells how much; 0: off",
      fmt::format("{}", settings.firefly_clamp));
  add_integer(
      app, "--target-fps", settings.target_fps, 0, 240,
      "Frames a second of realtime: --samples and --indirect-size are the most, less is taken where it is needed; "
      "0: just these");
  add_integer(
      app, "--warm-up", settings.warm_up, 0, 64,
      "Unseen frames of realtime before a picture that is not one of a stream, which begins with their history");
  add_integer(app, "--seed", settings.seed, 0, std::numeric_limits<std::uint32_t>::max(),
              "Start of the random sequence: the same seed gives the same picture");
}

void add_settings_options(CLI::App& app, Settings& settings) {
  app.option_defaults()->group("Light");
  add_transport_options(app, settings);
  app.option_defaults()->group("Display");
  add_display_options(app, settings);
}

void add_device_options(CLI::App& app, std::string& device, std::string& tracer) {
  app.option_defaults()->group("Device");
  add_parsed(app, "--device", device, parse_device, "INDEX|software",
             "The EGL device (see `lightwell devices`); without it the first GPU, else the software device");
  add_parsed(app, "--tracer", tracer, parse_tracer, "embree|compute|brute-force",
             "Who traces rays; without it what suits the device. brute-force tries every triangle with every ray");
}

}  // namespace lightwell
