#include "server/command_line/render_command.h"

#include <chrono>
#include <cstdio>

#include "renderer/tracing/embree/embree_tracer.h"
#include "server/command_line/add_option.h"
#include "server/command_line/environment_options.h"
#include "server/command_line/output_file.h"
#include "server/command_line/progress.h"
#include "server/command_line/render_report.h"
#include "server/command_line/scene_argument.h"
#include "server/command_line/settings_options.h"

namespace lightwell {

namespace {

constexpr double kLongestTime_s = 1e9;

void add_time_options(CLI::App& app, RenderArguments& arguments) {
  CLI::Option* time = add_parsed(
      app, "--time", arguments.time_s, [](const std::string& text) { return parse_number(text, 0.0, kLongestTime_s); },
      "SECONDS", "The moment of the scene's animation", "0");
  CLI::Option* frames = add_parsed(app, "--frames", arguments.frames, parse_frame_range, "A:B",
                                   "A sequence: frame N shows the moment N / fps; FILE holds %04d for N");
  frames->excludes(time);
  add_parsed(
      app, "--fps", arguments.fps, [](const std::string& text) { return parse_number(text, 1e-3, 1e4); }, "N",
      "Frames per second of a sequence", "30")
      ->needs(frames);
}

void add_camera_options(CLI::App& app, CameraArgument& camera) {
  CLI::Option* index = add_parsed(
      app, "--camera", camera.index,
      [](const std::string& text) -> Result<int> {
        const Result<long long> number = parse_integer(text, 0, 1'000'000);
        if (!number) return number.error();
        return static_cast<int>(*number);
      },
      "INDEX", "One of the scene's cameras; without it the first, else one that shows everything");
  CLI::Option* eye = add_parsed(app, "--eye", camera.eye, parse_vec3, "X,Y,Z", "Where to look from, in metres, +Y up");
  CLI::Option* target = add_parsed(app, "--target", camera.target, parse_vec3, "X,Y,Z", "What to look at");
  eye->needs(target)->excludes(index);
  target->needs(eye);
  add_parsed(
      app, "--yfov", camera.yfov_degrees, [](const std::string& text) { return parse_number(text, 0.1, 179.0); },
      "DEGREES", "Vertical field of view of --eye", "45")
      ->needs(eye);
}

ExitCode check_output(const RenderArguments& arguments) {
  const auto refuse = [&](const std::string& why) {
    return report_usage(invalid_input("--output", "\"" + arguments.output + "\" " + why));
  };
  if (!output_format_of(arguments.output)) return refuse("does not end in .exr, .png or .jpg");
  if (arguments.frames && !is_frame_pattern(arguments.output))
    return refuse("has no place for the frame's number: with --frames it must hold one %04d");
  if (const Status status = check_folder_of(arguments.output); !status) return report(status.error());
  return kDone;
}

// The frames of one picture, added up on the device: only the last one is read back in full.
Result<Frame> render_picture(Renderer& renderer, RenderView& view, const Scene& scene, FrameRequest request, int spp,
                             bool linear, Progress& progress, const std::string& name) {
  PictureCost cost;
  for (int i = 0; i < spp; ++i) {
    const bool last = i + 1 == spp;
    request.accumulate = i > 0;
    request.want_linear = last && linear;
    request.want_display = last && !linear;
    Result<Frame> frame = renderer.render(scene, request, view);
    if (!frame) return frame;
    cost.add(*frame);
    if (last) {
      cost.give(*frame);
      return frame;
    }
    progress.show(name + ": sample frame " + std::to_string(i + 1) + " of " + std::to_string(spp));
  }
  return Error{ErrorKind::kInternal, "--spp", "no frame was asked for"};
}

// Only the first picture starts from nothing: what comes after it has its history.
Status warm_up(Renderer& renderer, RenderView& view, const Scene& scene, FrameRequest request) {
  request.is_unseen = true;
  for (int i = 0; i < warm_up_frames(request.settings); ++i)
    if (const Result<Frame> frame = renderer.render(scene, request, view); !frame) return frame.error();
  return Done{};
}

Result<PlacedCamera> camera_at(const RenderArguments& arguments, const Scene& scene, double time_s) {
  const float aspect_ratio = static_cast<float>(arguments.size_px.x) / static_cast<float>(arguments.size_px.y);
  return place_camera(arguments.camera, pose_at(scene, time_s), aspect_ratio);
}

struct Pictures {
  Renderer& renderer;
  const RenderArguments& arguments;
  const Scene& scene;
  std::unique_ptr<RenderView> view;
  RenderReport& report;
  Progress progress{};
  bool is_warm = false;

  ExitCode render(const std::string& file, double time_s, const std::string& name) {
    FrameRequest request;
    request.time_s = time_s;
    request.size_px = arguments.size_px;
    request.settings = arguments.settings;
    const Result<PlacedCamera> camera = camera_at(arguments, scene, time_s);
    if (!camera) return report_usage(camera.error());
    request.camera = *camera;
    if (!is_warm)
      if (const Status warm = warm_up(renderer, *view, scene, request); !warm) return lightwell::report(warm.error());
    is_warm = true;
    const bool linear = output_format_of(file) == OutputFormat::kExr;
    const Result<Frame> frame = render_picture(renderer, *view, scene, request, arguments.spp, linear, progress, name);
    if (!frame) return lightwell::report(frame.error());
    const Status written = write_frame(file, *frame, exr_metadata(arguments, time_s, *frame));
    if (!written) return lightwell::report(written.error());
    report.add_picture(file, time_s, *frame);
    return kDone;
  }

  ExitCode render_all() {
    if (!arguments.frames) return render(arguments.output, arguments.time_s, arguments.output);
    const FrameRange range = *arguments.frames;
    const int count = range.last - range.first + 1;
    for (int number = range.first; number <= range.last; ++number) {
      const std::string file = frame_file_name(arguments.output, number);
      progress.show("frame " + std::to_string(number - range.first + 1) + " of " + std::to_string(count) + ": " + file);
      if (const ExitCode code = render(file, number / arguments.fps, file); code != kDone) return code;
    }
    return kDone;
  }
};

}  // namespace

void add_render_options(CLI::App& app, RenderArguments& arguments) {
  app.add_option("SCENE", arguments.scene, "A .glb or .gltf file, or builtin:NAME")->required();
  app.add_option("-o,--output", arguments.output,
                 "The picture: .exr holds linear light, .png and .jpg what a display shows")
      ->type_name("FILE")
      ->required();
  add_parsed(app, "--size", arguments.size_px, parse_size, "WxH", "The picture's size in pixels", "512x512");
  add_integer(app, "--spp", arguments.spp, 1, 1'000'000, "Frames that are accumulated into the picture");
  app.add_flag("--json", arguments.json, "Print timings per stage, rays, triangles and the device as JSON");
  app.option_defaults()->group("Time");
  add_time_options(app, arguments);
  app.option_defaults()->group("Camera");
  add_camera_options(app, arguments.camera);
  add_settings_options(app, arguments.settings);
  app.option_defaults()->group("Light");
  add_environment_options(app, arguments.environment);
  add_device_options(app, arguments.device, arguments.tracer);
}

ExitCode run_render(const RenderArguments& arguments) {
  if (const ExitCode code = check_output(arguments); code != kDone) return code;
  if (const Status status = check_settings(arguments.settings, arguments.size_px); !status)
    return report_usage(Error{status.error().kind, "--" + status.error().where, status.error().what});
  RenderReport report(arguments);
  const Result<Scene> scene = load_scene_argument(arguments.scene, arguments.environment);
  if (!scene) return lightwell::report(scene.error());
  report.scene_loaded();
  if (const Result<PlacedCamera> camera = camera_at(arguments, *scene, arguments.time_s); !camera)
    return report_usage(camera.error());
  RendererOptions options{{arguments.device}, arguments.tracer, [] { return make_embree_tracer(); }};
  options.compile_ahead = false;
  Renderer renderer(options);
  report.renderer_started(renderer);
  Pictures pictures{renderer, arguments, *scene, renderer.make_view(), report};
  if (const ExitCode code = pictures.render_all(); code != kDone) return code;
  pictures.progress.clear();
  report.print();
  return kDone;
}

}  // namespace lightwell
