// Ten thousand frames of the realtime method with everything in motion: what the heap, the process and the device hold
// after the first thousands and at the end.
#include <malloc.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <limits>

#include "renderer/gl/memory.h"
#include "renderer/renderer.h"
#include "renderer/scene/bounds.h"
#include "renderer/scene/builtin.h"
#include "renderer/scene/pose.h"
#include "renderer/tracing/embree/embree_tracer.h"
#include "renderer/tracing/tracer.h"
#include "tests/bench/report.h"

namespace lightwell::bench {
namespace {

struct Options {
  int first = 2000, frames = 10000, side_px = 128;
  bool as_json = false, check = false;
};

constexpr double kFrames_s = 30.0;
constexpr int kLookedAt = 60;
constexpr double kMostHeap = 16.0;                       // bytes a frame
constexpr double kMostResident = 2.0 * 1024.0 * 1024.0;  // arenas take a megabyte at a time
constexpr double kMostDevice = 1024.0 * 1024.0;          // buffers grow to the most that a frame has needed

/// What is held, bytes.
struct Held {
  double heap = std::numeric_limits<double>::infinity();  // allocated and not freed
  double resident = std::numeric_limits<double>::infinity();
  double device = 0.0;  // in textures and buffers

  /// Between frames drivers keep buffers or do not: the least of some frames is what they all hold.
  void look() {
    std::ifstream file("/proc/self/statm");
    double pages = 0.0, resident_pages = 0.0;
    file >> pages >> resident_pages;
    const auto heap_now = mallinfo2();
    heap = std::min(heap, static_cast<double>(heap_now.uordblks + heap_now.hblkhd));
    resident = std::min(resident, resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE)));
    device = static_cast<double>(gl::device_memory().own_bytes);
  }
};

/// The Cornell box with its tall block skinned and morphed: it turns by its joint, and leans and straightens.
Scene bending_cornell() {
  constexpr float kDuration_s = 8.0f;
  constexpr int kKeys = 32;
  Scene scene = builtin_scene("cornell").value();
  const auto block =
      std::find_if(scene.nodes.begin(), scene.nodes.end(), [](const Node& node) { return node.name == "tall block"; });
  if (block == scene.nodes.end()) throw std::runtime_error("cornell has no tall block");
  const int block_index = static_cast<int>(block - scene.nodes.begin()), joint = static_cast<int>(scene.nodes.size());
  auto mesh = std::make_shared<Mesh>(*scene.meshes[static_cast<std::size_t>(block->mesh)]);
  for (Primitive& primitive : mesh->primitives) {
    MorphTarget leaning;
    for (const glm::vec3& position : primitive.positions) leaning.positions.push_back({0.3f * position.y, 0, 0});
    primitive.morph_targets = {leaning};
    primitive.joints.assign(primitive.positions.size(), glm::uvec4(0));
    primitive.weights.assign(primitive.positions.size(), glm::vec4(1, 0, 0, 0));
    fill_bounds(primitive);
  }
  scene.meshes.push_back(mesh);
  block->mesh = static_cast<int>(scene.meshes.size()) - 1;
  block->skin = static_cast<int>(scene.skins.size());
  Node bone;
  bone.local = block->local;
  scene.skins.push_back({"", {joint}, {glm::mat4(1.0f)}});
  scene.roots.push_back(joint);
  scene.nodes.push_back(bone);
  AnimationChannel turn, lean;
  turn.node = joint, turn.property = AnimatedProperty::kRotation, turn.width = 4;
  lean.node = block_index, lean.property = AnimatedProperty::kWeights, lean.width = 1;
  for (int key = 0; key <= kKeys; ++key) {
    const float phase = static_cast<float>(key) / kKeys, angle = glm::radians(360.0f) * phase;
    const glm::quat rotation = glm::angleAxis(angle, glm::vec3(0, 1, 0)) * bone.local.rotation;
    turn.times_s.push_back(kDuration_s * phase), lean.times_s.push_back(kDuration_s * phase);
    turn.values.insert(turn.values.end(), {rotation.x, rotation.y, rotation.z, rotation.w});
    lean.values.push_back(0.5f + 0.5f * std::sin(angle));
  }
  scene.animations.push_back({"bends", {turn, lean}, {}, kDuration_s});
  return scene;
}

Row measure(Renderer& renderer, const std::string& name, const Scene& scene, const Options& options) {
  const auto view = renderer.make_view();
  FrameRequest request;
  request.size_px = glm::ivec2(options.side_px);
  request.settings.method = Method::kRealtime;
  request.settings.bounces = 3;
  request.settings.indirect_size = std::max(8, options.side_px / 4);
  Held first, last;
  for (int frame = 0; frame < options.frames; ++frame) {
    request.time_s = frame / kFrames_s;
    const Pose pose = pose_at(scene, request.time_s);
    request.camera = pose.cameras.empty() ? frame_camera(pose, 1.0f) : pose.cameras.front();
    if (const Result<Frame> made = renderer.render(scene, request, *view); !made)
      throw std::runtime_error(made.error().message());
    if (frame >= options.first - kLookedAt && frame < options.first) first.look();
    if (frame >= options.frames - kLookedAt) last.look();
  }
  const double mebi = 1024.0 * 1024.0;
  return {{{"scene", name}, {"from frame", std::to_string(options.first)}, {"to", std::to_string(options.frames)}},
          {{"heap bytes a frame", (last.heap - first.heap) / (options.frames - options.first)},
           {"resident MiB", last.resident / mebi},
           {"more resident bytes", last.resident - first.resident},
           {"more device bytes", last.device - first.device}}};
}

bool is_within_bounds(const Row& row) {
  return row.figures[0].second < kMostHeap && row.figures[2].second < kMostResident &&
         row.figures[3].second < kMostDevice;
}

int run(const Options& options) {
  RendererOptions renderer_options;
  renderer_options.make_native_tracer = [] { return make_embree_tracer(); };
  Renderer renderer(renderer_options);
  Report report;
  report.machine = {{"device", renderer.context().device().gl_renderer},
                    {"picture", std::to_string(options.side_px) + " pixels a side"}};
  bool good = true;
  const std::pair<std::string, Scene> scenes[] = {{"helicopters", builtin_scene("helicopters").value()},
                                                  {"cornell, a block skinned and morphed", bending_cornell()}};
  for (const auto& [name, scene] : scenes) {
    const Row row = measure(renderer, name, scene, options);
    good = good && is_within_bounds(row);
    report.section("memory over frames in motion").push_back(row);
  }
  if (options.as_json)
    print_json(report, std::cout);
  else
    print_table(report, std::cout);
  return options.check && !good ? 1 : 0;
}

}  // namespace
}  // namespace lightwell::bench

int main(int count, char** arguments) {
  lightwell::bench::Options options;
  CLI::App app("Whether the realtime method's memory grows with the frames");
  app.add_option("--first", options.first, "Frames before the first look")->check(CLI::Range(100, 1000000));
  app.add_option("--frames", options.frames, "Frames of a scene")->check(CLI::Range(200, 1000000));
  app.add_option("--side", options.side_px, "The picture's side in pixels")->check(CLI::Range(8, 4096));
  app.add_flag("--json", options.as_json, "Print JSON");
  app.add_flag("--check", options.check, "Exit with 1 if memory grows");
  CLI11_PARSE(app, count, arguments);
  try {
    return lightwell::bench::run(options);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
