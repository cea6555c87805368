#include "renderer/renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <iterator>
#include <optional>

#include "renderer/check.h"
#include "renderer/lanes/choose.h"
#include "renderer/methods/brute_force.h"
#include "renderer/methods/realtime.h"
#include "renderer/methods/reference.h"
#include "renderer/methods/thesis.h"
#include "renderer/passes/bindings.glsl"
#include "renderer/passes/brdf_table.h"
#include "renderer/passes/camera_block.h"
#include "renderer/passes/hand_over.h"
#include "renderer/passes/history_view.h"
#include "renderer/tracing/tracer.h"

namespace lightwell {

namespace {

// Exposure follows the light as an eye does, in seconds of the scene; while the scene stands still, of frames like
// these.
constexpr double kExposureTime_s = 0.4;
constexpr double kStillFrame_s = 0.05;

class View : public RenderView {
 public:
  View(gl::ShaderLibrary& shaders, gl::BufferUse buffers) : display(shaders), shaders_(shaders), buffers_(buffers) {}

  // Made when first asked for: their images and shaders are many.
  ThesisMethod& thesis() {
    if (!thesis_) thesis_.emplace(shaders_, buffers_);
    return *thesis_;
  }
  RealtimeMethod& realtime() {
    if (!realtime_) realtime_.emplace(shaders_, buffers_);
    return *realtime_;
  }
  ReferenceMethod& reference() {
    if (!reference_) reference_.emplace(shaders_, buffers_);
    return *reference_;
  }

  /// The picture to show of what a method has made: its own, or one on its way from another method's to `reference`.
  const Picture& handed_over(const Picture& made, Method method, std::uint32_t frames) {
    if (method != Method::kReference) {
      other_methods_picture_ = &made;
      other_method_ = method;
      return made;
    }
    const bool has_other = other_methods_picture_ && other_methods_picture_->image.size_px() == made.image.size_px();
    if (frames == 0 || !has_other) return made;
    if (!hand_over_) hand_over_.emplace(shaders_);
    return hand_over_->run(made, *other_methods_picture_, other_method_, frames);
  }

  DisplayPass display;
  // How much of the way to the exposure of a picture of this moment to go: all of it in the first picture, when the
  // time jumps, and for a picture that is refined.
  float exposure_share(double time_s) {
    const double passed_s = exposed_time_s_ ? std::abs(time_s - *exposed_time_s_) : kLongAgo_s;
    exposed_time_s_ = time_s;
    if (accumulated > 0) return 1.0f;
    return static_cast<float>(1.0 - std::exp(-std::max(passed_s, kStillFrame_s) / kExposureTime_s));
  }

  std::uint32_t accumulated = 0;

 private:
  static constexpr double kLongAgo_s = 1e3;
  std::optional<double> exposed_time_s_;
  gl::ShaderLibrary& shaders_;
  gl::BufferUse buffers_;
  std::optional<ThesisMethod> thesis_;
  std::optional<RealtimeMethod> realtime_;
  std::optional<ReferenceMethod> reference_;
  std::optional<HandOverPass> hand_over_;
  const Picture* other_methods_picture_ = nullptr;  // made last; its method's own
  Method other_method_ = Method::kThesis;
};

// Views of surfaces are those of `thesis`, whatever the method.
Method method_of(const Settings& settings) {
  const ViewKind view = settings.view;
  const bool of_history = settings.method == Method::kRealtime && settings.bounces > 0 && HistoryViewPass::shows(view);
  return every_method_shows(view) || of_history ? settings.method : Method::kThesis;
}

std::vector<Coverage> coverage_of(const Scene& scene, const Pose& pose) {
  std::vector<Coverage> all;
  all.reserve(pose.instances.size());
  for (const Instance& instance : pose.instances) {
    Coverage coverage;
    if (instance.material >= 0) {
      const Material& material = scene.materials[static_cast<std::size_t>(instance.material)];
      coverage.mode = material.alpha_mode;
      coverage.cutoff = material.alpha_cutoff;
      coverage.factor = material.base_color_factor.a;
      coverage.use = material.base_color_texture;
      coverage.double_sided = material.double_sided;
      if (coverage.mode != AlphaMode::kOpaque && coverage.use.texture >= 0) {
        const Texture& texture = scene.textures[static_cast<std::size_t>(coverage.use.texture)];
        if (texture.image >= 0) coverage.image = scene.images[static_cast<std::size_t>(texture.image)];
        coverage.wrap_s = texture.sampler.wrap_s;
        coverage.wrap_t = texture.sampler.wrap_t;
      }
    }
    all.push_back(std::move(coverage));
  }
  return all;
}

// The stages of `realtime` whose time grows with the rays of the indirect map, and with its texels.
FrameTimes times_of(const Frame& frame) {
  constexpr std::string_view kOfRays[] = {"directions", "trace", "light of hits", "shadows of hits", "radiance cache"};
  FrameTimes times{frame.total_ms, 0.0, 0.0};
  for (const StageTime& stage : frame.stages) {
    if (std::find(std::begin(kOfRays), std::end(kOfRays), stage.name) != std::end(kOfRays))
      times.of_rays_ms += stage.ms;
    if (stage.name == "reconstruction") times.of_map_ms += stage.ms;
  }
  return times;
}

// A low-discrepancy point about the pixel's middle, for anti-aliasing over accumulated frames: Roberts 2018 (R2).
glm::vec2 pixel_jitter(std::uint32_t frame_number) {
  if (frame_number == 0) return glm::vec2(0.0f);
  const double n = frame_number;
  return glm::vec2(glm::fract(0.5 + n * 0.7548776662466927), glm::fract(0.5 + n * 0.5698402909980532)) - 0.5f;
}

std::unique_ptr<Tracer> make_tracer(const RendererOptions& options, bool software) {
  const bool native = options.tracer.empty() ? software && options.make_native_tracer : options.tracer == "embree";
  if (options.tracer == "brute-force") return make_brute_force_tracer();
  if (!options.tracer.empty() && options.tracer != "embree" && options.tracer != "compute")
    throw std::runtime_error("--tracer takes embree, compute or brute-force, not \"" + options.tracer + "\"");
  if (native && !options.make_native_tracer) throw std::runtime_error("this build has no Embree tracer");
  return native ? options.make_native_tracer() : make_compute_tracer();
}

// A GPU is quicker than any processor.
std::unique_ptr<ViewRasterizer> make_view_rasterizer(SeenBy seen_by, Tracer& tracer, bool software) {
  if (!tracer.host() || seen_by == SeenBy::kDevice || (seen_by == SeenBy::kQuicker && !software)) return nullptr;
  return std::make_unique<ViewRasterizer>(*tracer.host(), lanes::view_kernels());
}

}  // namespace

struct Renderer::State {
  explicit State(const RendererOptions& options)
      : context(gl::Context::create(options.device)),
        timer(context->device().software),
        own_tracing([options, software = context->device().software] { return make_tracer(options, software); }),
        buffers(own_tracing.tracer->name() == "embree" ? gl::BufferUse::kHostVisible : gl::BufferUse::kDevice),
        view_rasterizer(make_view_rasterizer(options.seen_by, *own_tracing.tracer, context->device().software)),
        view_choice{view_rasterizer.get(), options.seen_by == SeenBy::kProcessor},
        device_scene(shaders, buffers),
        camera("camera", sizeof(CameraBlock)) {
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
  }

  Tracing& tracing(bool by_brute_force);
  CameraBlock bind_frame(const Scene& scene, const FrameRequest& request, glm::vec2 jitter_px);
  void show(View& view, const Picture& picture, const FrameRequest& request, Frame& frame);
  void read(const View& view, const Picture& picture, const FrameRequest& request, Frame& frame) const;

  std::unique_ptr<gl::Context> context;
  gl::ShaderLibrary shaders;
  gl::StageTimer timer;
  Tracing own_tracing;
  std::optional<Tracing> brute_force;  // made when it is first asked for
  gl::BufferUse buffers;
  std::unique_ptr<ViewRasterizer> view_rasterizer;  // null: the device draws all
  ViewChoice view_choice;
  DeviceScene device_scene;
  gl::Buffer camera;
  EnvironmentBlock environment;
  BrdfTable brdf_table{shaders};
};

Tracing& Renderer::State::tracing(bool by_brute_force) {
  if (!by_brute_force || own_tracing.tracer->name() == "brute-force") return own_tracing;
  if (!brute_force) brute_force.emplace(make_brute_force_tracer);
  return *brute_force;
}

CameraBlock Renderer::State::bind_frame(const Scene& scene, const FrameRequest& request, glm::vec2 jitter_px) {
  const CameraBlock block = make_camera_block(request.camera, request.size_px, jitter_px);
  camera.upload(std::span<const CameraBlock>(&block, 1));
  camera.bind_uniform(BINDING_CAMERA);
  environment.set(scene.environment, request.settings.background);
  environment.bind();
  brdf_table.bind();
  device_scene.bind();
  return block;
}

void Renderer::State::show(View& view, const Picture& picture, const FrameRequest& request, Frame& frame) {
  view.display.measure_exposure(picture, view.exposure_share(request.time_s));
  if (request.want_display) view.display.run(picture, request.settings);
  timer.mark("display");
  read(view, picture, request, frame);
  timer.mark("read back");
  frame.exposure_ev = request.settings.exposure_ev.value_or(view.display.measured_exposure_ev());
}

void Renderer::State::read(const View& view, const Picture& picture, const FrameRequest& request, Frame& frame) const {
  gl::wait_for_device();
  if (request.want_display) frame.display_rgbx = view.display.read_rgbx();
  if (request.want_linear) {
    frame.linear_rgb.resize(static_cast<std::size_t>(request.size_px.x) * static_cast<std::size_t>(request.size_px.y) *
                            3);
    glGetTextureImage(picture.image.id(), 0, GL_RGB, GL_FLOAT,
                      static_cast<GLsizei>(frame.linear_rgb.size() * sizeof(float)), frame.linear_rgb.data());
  }
}

int warm_up_frames(const Settings& settings) {
  return method_of(settings) == Method::kRealtime ? settings.warm_up : 0;
}

Renderer::Renderer(const RendererOptions& options) : state_(std::make_unique<State>(options)) {
  if (!options.compile_ahead) return;
  View view(state_->shaders, state_->buffers);
  view.thesis();
  view.realtime();
  view.reference();
}

Renderer::~Renderer() = default;

gl::Context& Renderer::context() {
  return *state_->context;
}

std::string_view Renderer::tracer_name() const {
  return state_->own_tracing.tracer->name();
}

std::unique_ptr<RenderView> Renderer::make_view() {
  return std::make_unique<View>(state_->shaders, state_->buffers);
}

Result<Frame> Renderer::render(const Scene& scene, const FrameRequest& request, RenderView& render_view) {
  if (Status good = check_settings(request.settings, request.size_px); !good) return good.error();
  auto& view = static_cast<View&>(render_view);
  const auto start = std::chrono::steady_clock::now();
  Frame frame;
  frame.size_px = request.size_px;
  try {
    // What `realtime` remembers from frame to frame would be torn by half a frame.
    const bool may_be_given_up = method_of(request.settings) != Method::kRealtime;
    state_->timer.begin_frame(may_be_given_up ? request.is_unwanted : std::function<bool()>());
    const Pose pose = pose_at(scene, request.time_s);
    state_->device_scene.prepare(scene, pose, request.settings.multiple_scattering);
    const bool by_brute_force = request.settings.brute_force && method_of(request.settings) == Method::kThesis;
    if (by_brute_force)
      if (Status good = check_brute_force(request.settings, request.size_px, state_->device_scene.triangles(),
                                          state_->context->device().software);
          !good)
        return good.error();
    const std::vector<Coverage> coverage = coverage_of(scene, pose);
    const TraceScene trace_scene{pose.instances, coverage, state_->device_scene.positions()};
    Tracing& tracing = state_->tracing(by_brute_force);
    tracing.tracer->update(trace_scene);
    if (state_->view_rasterizer) state_->view_rasterizer->update(trace_scene);
    view.accumulated = request.accumulate ? view.accumulated : 0;
    const Method method = method_of(request.settings);
    Settings settings = request.settings;
    // A view of surfaces by `thesis` in another method's place: its bounces, which may be without limit, do not show.
    if (method != settings.method) settings.bounces = std::min(settings.bounces, 1);
    if (method == Method::kRealtime) settings = view.realtime().budget().within(settings);
    // The paths of `reference` have a jitter of their own.
    const bool over_time = method == Method::kRealtime && settings.temporal_antialiasing && view.accumulated == 0;
    const glm::vec2 jitter_px = method == Method::kReference
                                    ? glm::vec2(0.0f)
                                    : pixel_jitter(over_time ? view.realtime().frame_number() : view.accumulated);
    const CameraBlock camera = state_->bind_frame(scene, request, jitter_px);
    state_->timer.mark("scene");

    FrameContext context{state_->device_scene,
                         pose,
                         settings,
                         request.size_px,
                         view.accumulated,
                         request.accumulate,
                         *tracing.tracer,
                         tracing.triangle_groups,
                         trace_scene,
                         state_->timer,
                         {camera, state_->view_choice}};
    const Picture& made = method == Method::kReference ? view.reference().render(context, scene)
                          : method == Method::kRealtime
                              ? view.realtime().render(context, scene, request.camera, jitter_px)
                              : view.thesis().render(context);
    const Picture& picture = view.handed_over(made, method, request.hand_over_frames);
    if (!request.is_unseen) state_->show(view, picture, request, frame);

    if (method == Method::kRealtime && !request.is_unseen) frame.clamped_share = view.realtime().clamped_share();
    view.accumulated = picture.accumulated;
    frame.accumulated = picture.accumulated;
    frame.rays = context.rays;
    frame.triangles = state_->device_scene.triangles();
    if (state_->view_rasterizer) frame.views_by_processor = state_->view_rasterizer->views_drawn();
  } catch (const gl::FrameUnwanted&) {
    view.accumulated = 0;
    return Error{ErrorKind::kUnwanted, "frame", "it was wanted no more"};
  } catch (const std::exception& error) {
    return Error{ErrorKind::kTooLarge, "scene", error.what()};
  }
  for (const auto& stage : state_->timer.end_frame()) frame.stages.push_back({stage.name, stage.ms});
  frame.total_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  if (method_of(request.settings) == Method::kRealtime) view.realtime().budget().note(times_of(frame));
  return frame;
}

}  // namespace lightwell
