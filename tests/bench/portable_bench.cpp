// What a machine does with the renderer's core: rays per second of the compute tracer, and milliseconds per stage of
// the built-in scenes' frames. Needs nothing but OpenGL. Usage: portable_bench [--device REQUEST] [--json FILE]
#include <chrono>
#include <cmath>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <thread>

#include "renderer/gl/device.h"
#include "renderer/renderer.h"
#include "renderer/scene/builtin.h"
#include "tests/bench/report.h"
#include "tests/gl/trace_scenes.h"

namespace lightwell::bench {
namespace {

constexpr int kRuns = 7;
constexpr double kLongEnough_s = 0.02;  // a run shorter than that is made of more rays
constexpr std::uint32_t kFewestRays = 1u << 16, kMostRays = 1u << 22;
constexpr int kFrames = 12, kWarmUpFrames = 3;

double seconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Rays on the device and room for what they hit.
struct RayBatch {
  explicit RayBatch(const std::vector<Ray>& rays)
      : count(static_cast<std::uint32_t>(rays.size())),
        ray_buffer("rays", rays.size() * sizeof(Ray)),
        hit_buffer("hits", rays.size() * sizeof(Hit)),
        visible_buffer("visible", rays.size() / 8 + 4) {
    ray_buffer.upload(std::span<const Ray>(rays));
  }
  std::uint32_t count;
  gl::Buffer ray_buffer, hit_buffer, visible_buffer;
};

using MakeRays = std::function<std::vector<Ray>(std::uint32_t count)>;

// As many rays as keep the device busy for a while, then the median over runs.
Row measure_rays(Tracer& tracer, const std::string& scene, const std::string& kind, const MakeRays& make_rays) {
  for (std::uint32_t count = kFewestRays;; count *= 4) {
    RayBatch batch(make_rays(count));
    const auto closest = [&] {
      tracer.closest_hit(batch.ray_buffer, batch.count, batch.hit_buffer);
      gl::wait_for_device();
    };
    const auto any = [&] {
      tracer.any_hit(batch.ray_buffer, batch.count, batch.visible_buffer);
      gl::wait_for_device();
    };
    closest(), any();
    if (seconds(closest) < kLongEnough_s && count < kMostRays) continue;
    std::vector<double> closest_s, any_s;
    for (int run = 0; run < kRuns; ++run) closest_s.push_back(seconds(closest)), any_s.push_back(seconds(any));
    const double millions = batch.count / 1e6;
    return {{{"scene", scene}, {"rays", kind}},
            {{"million rays", millions},
             {"closest hit Mray/s", millions / median(closest_s)},
             {"any hit Mray/s", millions / median(any_s)}}};
  }
}

std::vector<Hit> hits_of(Tracer& tracer, const std::vector<Ray>& rays) {
  RayBatch batch(rays);
  tracer.closest_hit(batch.ray_buffer, batch.count, batch.hit_buffer);
  std::vector<Hit> hits(rays.size());
  batch.hit_buffer.download(std::as_writable_bytes(std::span(hits)));
  return hits;
}

void measure_tracer(Report& report) {
  const std::pair<const char*, std::uint32_t> scenes[] = {{"3k", 39}, {"70k", 187}, {"600k", 548}};
  const auto width = [](std::uint32_t count) { return static_cast<std::uint32_t>(std::sqrt(count)); };
  const glm::vec3 eye{0.0f, 0.0f, 1.0f};
  for (const auto& [name, side] : scenes) {
    test::TraceWorld world;
    world.add(test::bumpy_shell(side));
    const auto tracer = make_compute_tracer();
    const double build_s = seconds([&] {
      tracer->update(world.scene());
      gl::wait_for_device();
    });
    auto& rows = report.section("compute tracer");
    rows.push_back(measure_rays(*tracer, name, "primary",
                                [&](std::uint32_t count) { return test::camera_rays(eye, width(count)); }));
    rows.push_back(measure_rays(*tracer, name, "diffuse", [&](std::uint32_t count) {
      const std::vector<Ray> first = test::camera_rays(eye, width(count / 16));
      return test::diffuse_rays(world, first, hits_of(*tracer, first), 16, 1);
    }));
    report.section("hierarchies")
        .push_back({{{"scene", name}},
                    {{"build ms", build_s * 1e3}, {"MiB", static_cast<double>(tracer->memory_bytes()) / (1 << 20)}}});
  }
}

// The frames of one scene in motion; the stages in the order in which they first appear.
void measure_frames(Report& report, Renderer& renderer, const std::string& name) {
  const Result<Scene> scene = builtin_scene(name);
  const auto view = renderer.make_view();
  std::vector<std::string> stages;
  std::map<std::string, std::vector<double>> stage_ms;
  std::vector<double> total_ms;
  FrameRequest request;
  for (int frame = 0; frame < kWarmUpFrames + kFrames; ++frame) {
    request.time_s = frame / 30.0;
    const Pose pose = pose_at(*scene, request.time_s);
    request.camera = pose.cameras.empty() ? frame_camera(pose, 1.0f) : pose.cameras.front();
    const Result<Frame> rendered = renderer.render(*scene, request, *view);
    if (!rendered) {
      report.section("errors").push_back({{{"scene", name}, {"error", rendered.error().message()}}, {}});
      return;
    }
    if (frame < kWarmUpFrames) continue;
    total_ms.push_back(rendered->total_ms);
    for (const StageTime& stage : rendered->stages) {
      auto& times = stage_ms[std::string(stage.name)];
      if (times.empty()) stages.emplace_back(stage.name);
      times.push_back(stage.ms);
    }
  }
  Row row{{{"scene", name}}, {{"frames/s", 1e3 / median(total_ms)}, {"total ms", median(total_ms)}}};
  for (const std::string& stage : stages) row.figures.emplace_back(stage + " ms", median(stage_ms[stage]));
  report.section("frames of 512 x 512, 32 samples, indirect 128, 1 bounce, compute tracer").push_back(row);
}

Report run(const gl::DeviceChoice& device) {
  Report report;
  RendererOptions options;
  options.device = device;
  options.tracer = "compute";
  Renderer renderer(options);
  const gl::DeviceInfo& info = renderer.context().device();
  report.machine = {{"device", info.gl_renderer},
                    {"OpenGL", info.gl_version},
                    {"chosen because", renderer.context().why()},
                    {"CPU threads", std::to_string(std::thread::hardware_concurrency())},
                    {"runs", "medians of " + std::to_string(kRuns) + " runs, " + std::to_string(kFrames) + " frames"}};
  measure_tracer(report);
  for (const std::string& name : builtin_scene_names()) measure_frames(report, renderer, name);
  for (const std::string& message : renderer.context().take_debug_messages())
    report.section("OpenGL messages").push_back({{{"message", message}}, {}});
  return report;
}

}  // namespace
}  // namespace lightwell::bench

int main(int count, char** arguments) {
  lightwell::gl::DeviceChoice device;
  std::string json_path;
  for (int i = 1; i < count; ++i) {
    const std::string argument = arguments[i];
    if (argument == "--device" && i + 1 < count) {
      device.request = arguments[++i];
    } else if (argument == "--json" && i + 1 < count) {
      json_path = arguments[++i];
    } else {
      std::cerr << "usage: portable_bench [--device REQUEST] [--json FILE]\n";
      return 2;
    }
  }
  try {
    const lightwell::bench::Report report = lightwell::bench::run(device);
    print_table(report, std::cout);
    if (json_path.empty()) return 0;
    std::ofstream file(json_path);
    print_json(report, file);
    return file.good() ? 0 : 1;
  } catch (const lightwell::gl::NoDevice& error) {
    std::cerr << error.what() << '\n';
    return 4;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
