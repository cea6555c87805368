#include "server/command_line/bench_thesis_command.h"

#include <chrono>
#include <cstdio>
#include <fstream>
#include <thread>

#include "renderer/image_metrics/error_measures.h"
#include "renderer/scene/builtin.h"
#include "renderer/tracing/embree/embree_tracer.h"
#include "server/command_line/add_option.h"
#include "server/command_line/output_file.h"
#include "server/command_line/progress.h"
#include "server/command_line/thesis/bench_plot.h"
#include "server/command_line/thesis/bench_report.h"
#include "server/command_line/thesis/frame_request.h"
#include "server/command_line/thesis/picture_options.h"
#include "server/command_line/thesis/tessellated_terrain.h"

namespace lightwell {

namespace {

// The lightest row of the tables, for the cost against triangles: there the triangles weigh most.
constexpr int kTerrainSamples = 32, kTerrainIndirectSide_px = 128;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string squared(int side_px) {
  return std::to_string(side_px) + "x" + std::to_string(side_px);
}

struct Bench {
  const BenchThesisArguments& arguments;
  // One at a time: each has a context of its own.
  std::unique_ptr<Renderer> renderer = make_renderer(arguments.tracer);
  ThesisBench found{};
  Progress progress{};

  std::unique_ptr<Renderer> make_renderer(const std::string& tracer) const {
    return std::make_unique<Renderer>(RendererOptions{{arguments.device}, tracer, [] { return make_embree_tracer(); }});
  }

  struct Measurement {
    FrameCost first, median;
    int frames = 0;
  };

  // A warm-up frame, then frames at moments all over the animation until they are enough or the budget is spent.
  Result<Measurement> measure(const Scene& scene, const Settings& settings, const std::string& name) {
    const auto start = std::chrono::steady_clock::now();
    const double duration_s = animation_duration_s(scene);
    const std::unique_ptr<RenderView> view = renderer->make_view();
    Measurement measurement;
    std::vector<FrameCost> costs;
    for (int number = 0; number <= arguments.most_frames; ++number) {
      if (number > 1 && seconds_since(start) > arguments.budget_s) break;
      progress.show(name + (number == 0 ? ": warm-up"
                                        : ": frame " + std::to_string(number) + " of at most " +
                                              std::to_string(arguments.most_frames)));
      const Result<Frame> frame = renderer->render(
          scene, square_frame(scene, moment_s(number, duration_s), arguments.side_px, settings), *view);
      if (!frame) return frame.error();
      if (number == 0)
        measurement.first = cost_of(*frame);
      else
        costs.push_back(cost_of(*frame));
    }
    measurement.median = median_cost(costs);
    measurement.frames = static_cast<int>(costs.size());
    return measurement;
  }

  Settings settings_for(int samples, int indirect_side_px) const {
    Settings settings = arguments.settings;
    settings.samples = samples;
    settings.indirect_size = scaled_indirect_side(indirect_side_px, arguments.side_px);
    return settings;
  }

  // Both at the animation's middle, with the same directions a pixel.
  Result<double> error_of_patches(const Scene& scene, const Settings& settings) {
    const auto picture_with = [&](int patch, int groups) -> Result<metrics::Picture> {
      Settings other = settings;
      other.patch = patch;
      other.triangle_groups = groups;
      FrameRequest request = square_frame(scene, 0.5 * animation_duration_s(scene), arguments.side_px, other);
      request.want_linear = true;
      const std::unique_ptr<RenderView> view = renderer->make_view();
      Result<Frame> frame = renderer->render(scene, request, *view);
      if (!frame) return frame.error();
      return metrics::Picture{frame->size_px.x, frame->size_px.y, std::move(frame->linear_rgb)};
    };
    if (settings.patch == 1 && settings.triangle_groups == 1) return 0.0;
    const Result<metrics::Picture> patches = picture_with(settings.patch, settings.triangle_groups);
    if (!patches) return patches.error();
    const Result<metrics::Picture> pixels = picture_with(1, 1);
    if (!pixels) return pixels.error();
    return metrics::linear_errors(*patches, *pixels).rel_mse;
  }

  Status measure_row(const PrintedRow& row) {
    const Result<Scene> scene = builtin_scene(row.scene);
    if (!scene) return scene.error();
    const Settings settings = settings_for(row.samples, row.indirect_side_px);
    const std::string name = "row " + std::to_string(found.rows.size() + 1) + " of " +
                             std::to_string(arguments.rows.size()) + " (" + std::string(row.scene) + ", " +
                             std::to_string(row.samples) + " samples, indirect " + squared(settings.indirect_size) +
                             ")";
    const Result<Measurement> measured = measure(*scene, settings, name);
    if (!measured) return measured.error();
    progress.show(name + ": its error");
    const Result<double> rel_mse = error_of_patches(*scene, settings);
    if (!rel_mse) return rel_mse.error();
    found.rows.push_back({row, settings.indirect_size, measured->median, measured->frames, *rel_mse});
    return Done{};
  }

  Status measure_terrain(int divisions) {
    const Settings settings = settings_for(kTerrainSamples, kTerrainIndirectSide_px);
    const std::string name = "terrain of " + std::to_string(kTerrainTriangles * divisions * divisions) + " triangles";
    progress.show(name + ": making it");
    const Scene scene = make_tessellated_terrain(divisions);
    const Result<Measurement> measured = measure(scene, settings, name);
    if (!measured) return measured.error();
    found.terrain_samples = settings.samples;
    found.terrain_indirect_side_px = settings.indirect_size;
    found.terrains.push_back({count_triangles(scene), measured->first.ms, measured->median, measured->frames});
    return Done{};
  }

  // One frame each, since the finest takes the better part of a minute; the coarsest is the warm-up of all.
  Status measure_brute_force() {
    renderer.reset();
    renderer = make_renderer("brute-force");
    const std::unique_ptr<RenderView> view = renderer->make_view();
    const Settings settings = settings_for(kTerrainSamples, kTerrainIndirectSide_px);
    int divisions = 1;
    for (MeasuredTerrain& terrain : found.terrains) {
      if (terrain.triangles > static_cast<std::uint64_t>(arguments.most_brute_triangles)) break;
      progress.show("terrain of " + std::to_string(terrain.triangles) + " triangles, by brute force");
      const Scene scene = make_tessellated_terrain(divisions);
      for (int frames = divisions == 1 ? 2 : 1; frames > 0; --frames) {
        const Result<Frame> frame =
            renderer->render(scene, square_frame(scene, 0.0, arguments.side_px, settings), *view);
        if (!frame) return frame.error();
        terrain.brute_force = cost_of(*frame);
      }
      divisions *= 2;
    }
    return Done{};
  }

  Status measure_all() {
    found.device = renderer->context().device().gl_renderer;
    found.tracer = renderer->tracer_name();
    found.threads = std::thread::hardware_concurrency();
    found.side_px = arguments.side_px;
    found.bounces = arguments.settings.bounces;
    found.patch = arguments.settings.patch;
    found.triangle_groups = arguments.settings.triangle_groups;
    for (const PrintedRow& row : arguments.rows)
      if (const Status status = measure_row(row); !status) return status;
    for (int divisions = 1; divisions <= kMaxTerrainDivisions; divisions *= 2) {
      if (kTerrainTriangles * divisions * divisions > arguments.most_triangles) break;
      if (const Status status = measure_terrain(divisions); !status) return status;
    }
    found.most_brute_triangles = found.tracer == "brute-force" ? 0 : arguments.most_brute_triangles;
    if (found.most_brute_triangles > 0 && !found.terrains.empty())
      if (const Status status = measure_brute_force(); !status) return status;
    progress.clear();
    return Done{};
  }
};

Status write_text(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file << text;
  file.close();
  if (!file) return Error{ErrorKind::kInternal, path, "cannot be written"};
  return Done{};
}

// Found out before minutes of work, not after them.
ExitCode check_arguments(const BenchThesisArguments& arguments) {
  if (const Status status = check_picture_options(arguments.side_px, arguments.settings); !status)
    return report_usage(status.error());
  if (!arguments.plot.empty() && !arguments.plot.ends_with(".svg"))
    return report_usage(invalid_input("--plot", "\"" + arguments.plot + "\" does not end in .svg"));
  for (const std::string& file : {arguments.json, arguments.plot})
    if (!file.empty())
      if (const Status status = check_folder_of(file); !status) return report(status.error());
  return kDone;
}

}  // namespace

void add_bench_thesis_options(CLI::App& app, BenchThesisArguments& arguments) {
  add_parsed(app, "--rows", arguments.rows, select_printed_rows, "ROWS",
             "Rows of tables 6.1 (1 to 18) and 6.2 (19 to 36), as in 1,4:6; or none", "all");
  add_integer(app, "--most-triangles", arguments.most_triangles, 0, 6'000'000,
              "The finest terrain of the cost against triangles; 0 leaves it out");
  add_integer(
      app, "--most-brute-triangles", arguments.most_brute_triangles, 0, 6'000'000,
      "The finest of them that brute force is measured for as well, which takes time in proportion; 0 for none");
  add_integer(app, "--frames", arguments.most_frames, 1, 10'000, "Frames measured for each row, at most");
  add_parsed(
      app, "--budget", arguments.budget_s, [](const std::string& text) { return parse_number(text, 0.0, 1e6); },
      "SECONDS", "Time for each row, after which no further frame begins; one is measured in any case", "20");
  app.add_option("--json", arguments.json, "Write what was measured as JSON")->type_name("FILE");
  app.add_option("--plot", arguments.plot, "Write it as curves, an .svg")->type_name("FILE");
  add_picture_options(app, arguments.side_px, arguments.settings, arguments.device, arguments.tracer);
}

ExitCode run_bench_thesis(const BenchThesisArguments& arguments) {
  if (const ExitCode code = check_arguments(arguments); code != kDone) return code;
  Bench bench{arguments};
  if (const Status status = bench.measure_all(); !status) return report(status.error());
  std::fputs(text_report(bench.found).c_str(), stdout);
  if (!arguments.json.empty())
    if (const Status status = write_text(arguments.json, json_report(bench.found).dump(2) + "\n"); !status)
      return report(status.error());
  if (!arguments.plot.empty())
    if (const Status status = write_text(arguments.plot, svg_of(plots_of(bench.found))); !status)
      return report(status.error());
  return kDone;
}

}  // namespace lightwell
