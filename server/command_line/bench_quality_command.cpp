#include "server/command_line/bench_quality_command.h"

#include <cstdio>
#include <fstream>

#include "renderer/scene/builtin.h"
#include "renderer/tracing/embree/embree_tracer.h"
#include "server/command_line/add_option.h"
#include "server/command_line/output_file.h"
#include "server/command_line/progress.h"
#include "server/command_line/quality_plot.h"
#include "server/command_line/settings_options.h"

namespace lightwell {

namespace {

Status write_text(const std::string& path, const std::string& text) {
  if (path.empty()) return Done{};
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) return Error{ErrorKind::kInternal, path, "cannot be written"};
  return Done{};
}

}  // namespace

void add_bench_quality_options(CLI::App& quality, BenchQualityArguments& arguments) {
  QualityPlan& plan = arguments.plan;
  quality.add_option("--scene", plan.scenes, "A built-in scene; repeatable; without it all")
      ->type_name("NAME")
      ->expected(1)
      ->take_all();
  add_parsed(quality, "--size", plan.size_px, parse_size, "WxH", "The pictures' size in pixels", "256x256");
  add_integer(quality, "--bounces", plan.bounces, 0, 64, "Of all methods");
  add_integer(quality, "--reference-spp", plan.reference_spp, 16, 1'000'000, "Samples of the converged picture");
  add_integer(quality, "--runs", plan.runs, 1, 100, "Of each setting; the time is their median");
  quality.add_option("--plot", arguments.plot, "Write error against time as an .svg")->type_name("FILE");
  quality.add_option("--json", arguments.json, "Write the figures as JSON")->type_name("FILE");
  add_device_options(quality, arguments.device, arguments.tracer);
}

ExitCode run_bench_quality(const BenchQualityArguments& arguments) {
  QualityPlan plan = arguments.plan;
  if (plan.scenes.empty())
    for (const auto& name : builtin_scene_names()) plan.scenes.emplace_back(name);
  for (const std::string& file : {arguments.plot, arguments.json})
    if (!file.empty())
      if (const Status status = check_folder_of(file); !status) return report(status.error());
  RendererOptions options{{arguments.device}, arguments.tracer, [] { return make_embree_tracer(); }};
  options.compile_ahead = false;
  Renderer renderer(options);
  Progress progress;
  const Result<std::vector<SceneQuality>> scenes =
      measure_quality(renderer, plan, [&](const std::string& what) { progress.show(what); });
  progress.clear();
  if (!scenes) return report(scenes.error());
  std::fputs(to_text(*scenes).c_str(), stdout);
  const std::string device = renderer.context().device().gl_renderer;
  if (const Status status = write_text(arguments.plot, quality_svg(*scenes)); !status) return report(status.error());
  const Status status = write_text(arguments.json, to_json(plan, *scenes, device).dump(2) + "\n");
  return status ? kDone : report(status.error());
}

}  // namespace lightwell
