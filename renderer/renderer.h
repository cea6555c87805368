// The public face: Scene + FrameRequest -> Frame. One Renderer per device; all calls from the thread that made it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/error.h"
#include "renderer/gl/device.h"
#include "renderer/scene/pose.h"
#include "renderer/scene/scene.h"

namespace lightwell {

class Tracer;

enum class Method { kThesis, kRealtime, kReference };
enum class Estimator { kCorrected, kLiteral };
/// isSimilar of the thesis: depths that differ by less than the threshold, or by more, as it is printed.
enum class Similarity { kCorrected, kLiteral };
/// Light: the picture, its parts, one bounce alone. Surfaces: albedo to normal-depth. The rest is of the indirect map's
/// pixels: mean distance of the hits, one direction and its hit's distance, the patch, to which patch the pixel refers,
/// how many candidates it has, and whether it refers to none. The last five are of `realtime`: frames in a pixel's
/// history, how much its light varies and changes, its motion, its cell of the radiance cache. Values are VIEW_* in
/// passes/bindings.glsl.
enum class ViewKind {
  kFinal,
  kDirect,
  kIndirect,
  kAlbedo,
  kNormal,
  kDepth,
  kOcclusionDistance,
  kPosition,
  kNormalDepth,
  kBounce,
  kDirection,
  kHitDistance,
  kPatch,
  kReference,
  kCandidates,
  kUnmatched,
  kHistory,
  kVariance,
  kGradient,
  kMotion,
  kCacheCells
};
enum class ToneMap { kNeutral, kLinear };
/// How `reference` finds lights that have a size: samples of the lights and rays that hit them, weighted together, or
/// one of the two alone. All have the same mean.
enum class LightStrategy { kBoth, kLights, kRays };

/// Who finds what cameras and shadow maps see. With the native tracer the processor is quicker than a software device
/// where triangles are many for the pixels. The other two, for comparing them: always the device, and the processor
/// wherever it can.
enum class SeenBy { kQuicker, kDevice, kProcessor };

/// Settings::bounces of `--bounces inf`: paths end by chance alone. `reference` and `realtime`; for the latter 3 and
/// more are the same, since its radiance cache carries all further bounces.
constexpr int kUnlimitedBounces = 1 << 20;

/// Of Settings::firefly_clamp.
constexpr float kMostFireflyClamp = 1e6f;

/// Names as they stand on the command line and in the API ("thesis", "occlusion-distance", ...); empty optional if
/// unknown.
std::optional<Method> method_from_name(std::string_view name);
std::optional<Estimator> estimator_from_name(std::string_view name);
std::optional<Similarity> similarity_from_name(std::string_view name);
std::optional<ViewKind> view_kind_from_name(std::string_view name);
std::optional<ToneMap> tone_map_from_name(std::string_view name);
std::optional<LightStrategy> light_strategy_from_name(std::string_view name);
std::string_view name_of(Method method);
std::string_view name_of(Estimator estimator);
std::string_view name_of(Similarity similarity);
std::string_view name_of(ViewKind view);
std::string_view name_of(ToneMap tone_map);
std::string_view name_of(LightStrategy strategy);

/// Whether it is of light as all methods know it: the picture, its direct or its indirect part.
bool every_method_shows(ViewKind view);

/// All views, in the order of their values.
std::span<const ViewKind> all_view_kinds();

/// How a picture is made. Ranges are checked by `check_settings`. `reference` makes one path per pixel and frame and
/// knows method, bounces, light_strategy, photon_guides, seed and what is displayed; its views of surfaces are those of
/// `thesis`.
struct Settings {
  Method method = Method::kThesis;
  /// Directions per pixel of the indirect map, 1..4096. `realtime` spreads them over 16 frames; with 8 and less,
  /// patches of two pixels of the map, with 4 and less of four, have one ray a frame, and their pixels turns.
  int samples = 32;
  int bounces = 1;          // 0: direct only; 1: first bounce; ... 64, or kUnlimitedBounces
  int indirect_size = 128;  // the indirect map's longer side in pixels, 8..4096
  int patch = 1;            // side of the patches that share directions, pixels of the indirect map: 1, 2, 4, 8 or 16
  int triangle_groups = 1;  // the nearest triangle of each group is a patch's candidate, 1..64
  float normal_threshold = 0.9f;  // cosine above which normals are similar, -1..1
  float depth_threshold = 0.05f;  // relative difference below which depths are similar, 0..10
  Similarity similarity = Similarity::kCorrected;
  bool trace_missed =
      true;  // a pixel that none of its candidates lies before traces that ray itself (not in the thesis)
  /// Of `thesis`: every ray tries every triangle, as in its own implementation. Frames in which that would take seconds
  /// are refused.
  bool brute_force = false;
  Estimator estimator = Estimator::kCorrected;
  ViewKind view = ViewKind::kFinal;
  int view_index = 0;                // which direction (from 0) or bounce (from 1) the views of one of them show
  std::optional<float> exposure_ev;  // fixed exposure (linear scale 2^ev); none: median luminance, smoothed in time
  ToneMap tone_map = ToneMap::kNeutral;
  std::uint32_t seed = 0;
  std::optional<glm::vec3> background;  // linear nit behind everything the camera sees; none: the environment
  int shadow_size = 512;                // a shadow map's side in pixels, 64..4096
  int shadow_filter = 3;                // its box filter's width in pixels, odd, 1..15
  bool denoise = false;                 // edge-stopping filter over the indirect map (not in the thesis)
  bool multiple_scattering = false;     // light between microfacets is kept: rough surfaces lose no energy
  LightStrategy light_strategy = LightStrategy::kBoth;
  bool photon_guides = true;  // of `reference`: photons tell paths where mirrors throw light from
  /// Of `realtime`, frames a second, 0..240: samples and indirect_size are what the picture has at most, and fewer
  /// (4 and 32 at least) where frames would take longer. What is measured decides, so that pictures differ from run to
  /// run; 0: as they are set.
  int target_fps = 0;
  bool temporal_antialiasing = false;  // of `realtime`: pictures of a shifted camera are averaged along what moves
  /// Of `realtime`, 0..kMostFireflyClamp, 0: off. What one sample brings of light that has bounced is scaled down to at
  /// most so many times what samples bring in the mean, over the frames so far; luminance, before the pixel's albedo.
  /// Light straight from lamps and the sky, and what mirrors show, is left alone. Takes light away:
  /// Frame::clamped_share.
  float firefly_clamp = 0.0f;
  /// Of `realtime`, 0..64: a picture that is not one of a stream has so many unseen frames before it, whose history it
  /// begins with. Renderer::render leaves them to its caller, see warm_up_frames().
  int warm_up = 0;
  bool hand_over = true;  // of a server's sessions: a picture that has long stood still goes over into `reference`
};

/// How many unseen frames a picture from a standing start is to have before it: Settings::warm_up where the picture is
/// made by `realtime`, else 0.
int warm_up_frames(const Settings& settings);

/// The first setting out of range, by its name on the command line; Done if all are good.
Status check_settings(const Settings& settings, glm::ivec2 size_px);

/// One picture of a scene.
struct FrameRequest {
  double time_s = 0.0;
  PlacedCamera camera;
  glm::ivec2 size_px{512, 512};
  Settings settings;
  bool accumulate = false;  // add to the view's earlier frames of the very same request (scene unchanged): refinement
  /// Of `reference`, where the view has shown the very same by another method last: that picture goes over into the
  /// paths' without a step, and with so many frames all of it is theirs. 0: at once.
  std::uint32_t hand_over_frames = 0;
  /// Asked at the end of every stage, but for `realtime`, whose frames are always finished; true: the picture is wanted
  /// no more, and `render` gives kUnwanted. May be empty.
  std::function<bool()> is_unwanted;
  bool is_unseen = false;    // only to be remembered, for the frames that follow: nothing of it is read or exposed by
  bool want_linear = false;  // Frame::linear_rgb is filled as well: scene-referred, no exposure, no tone curve
  bool want_display = true;  // Frame::display_rgbx is filled: exposed, tone-mapped, sRGB
};

struct StageTime {
  std::string_view name;  // "g-buffer", "shadow maps", "rays", "trace", "shade hits", "gather", "compose", "readback"
  double ms = 0.0;
};

struct Frame {
  glm::ivec2 size_px{0};
  std::vector<std::uint8_t> display_rgbx;  // 4 bytes a pixel, row 0 at the top
  std::vector<float> linear_rgb;           // 3 floats a pixel, row 0 at the top
  float exposure_ev = 0.0f;                // what was applied
  std::uint32_t accumulated = 1;           // frames in this picture
  float clamped_share = 0.0f;              // of the indirect light, what Settings::firefly_clamp took away, 0..1
  std::vector<StageTime> stages;
  double total_ms = 0.0;
  std::uint64_t rays = 0;  // traced, those among them that candidates missed and that were traced anew
  std::uint64_t triangles = 0;
  std::uint32_t views_by_processor = 0;  // of what camera and shadow maps see; the device draws the others
};

/// What one viewer's pictures share over time: images of its size, exposure, history. Made by a Renderer,
/// used and destroyed on its thread, before it.
class RenderView {
 public:
  virtual ~RenderView() = default;
};

struct RendererOptions {
  gl::DeviceChoice device;
  std::string tracer;  // "" (compute on a GPU, else the native one if given), "embree", "compute" or "brute-force"
  /// Makes the native tracer; the core does not link it. Empty: there is none.
  std::function<std::unique_ptr<Tracer>()> make_native_tracer;
  SeenBy seen_by = SeenBy::kQuicker;
  /// Compiles the methods' shaders at the start, so that no frame waits for them; else each when it is first used.
  bool compile_ahead = true;
};

class Renderer {
 public:
  /// Throws gl::NoDevice, or std::runtime_error when a shader or the tracer's name is refused.
  explicit Renderer(const RendererOptions& options);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  gl::Context& context();
  std::string_view tracer_name() const;

  std::unique_ptr<RenderView> make_view();

  /// Renders. Bad settings or a scene over the device's limits are errors; the view stays usable.
  Result<Frame> render(const Scene& scene, const FrameRequest& request, RenderView& view);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lightwell
