// The body of POST /v1/sequences, read, written and read again, and what it makes of a scene: every frame of it either
// can be had or is refused by a problem that says why.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <string_view>

#include "protocol/json_text.h"
#include "protocol/sequence.h"
#include "renderer/scene/builtin.h"
#include "server/sequences/sequence_plan.h"

namespace lightwell {
namespace {

constexpr int kMostFrames = 100;
constexpr std::uint32_t kFramesTried = 3;

[[noreturn]] void fail(std::string_view what) {
  std::cerr << what << '\n';
  std::abort();
}

void check_problem(const protocol::Problem& problem) {
  if (problem.status < 400 || problem.status > 499 || problem.detail.empty()) fail("a problem that says nothing");
}

void check_shot(const Shot& shot) {
  if (!check_settings(shot.request.settings, shot.request.size_px)) fail("settings that the renderer refuses");
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(shot.request.camera.world_from_view[column][row])) fail("a camera that is nowhere");
}

void plan(const protocol::SequenceRequest& request) {
  static const auto stage = std::make_shared<const StagedScene>(*builtin_scene("cornell"));
  ServeOptions options;
  options.limits.max_sequence_frames = kMostFrames;
  const auto made = SequencePlan::make(request, stage, options);
  if (!made) return check_problem(made.problem());
  const std::uint32_t frames = request.last_frame - request.first_frame + 1;
  if (frames == 0 || frames > kMostFrames) fail("more frames than may be");
  for (std::uint32_t i = 0; i < std::min(frames, kFramesTried); ++i) {
    const auto shot = (*made)->shot(request.first_frame + i, i % (*made)->views());
    shot ? check_shot(*shot) : check_problem(shot.problem());
  }
}

}  // namespace
}  // namespace lightwell

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lightwell;
  const auto parsed = protocol::parse_sequence_request({reinterpret_cast<const char*>(data), size});
  if (!parsed) {
    check_problem(parsed.problem());
    return 0;
  }
  const auto again = protocol::parse_sequence_request(protocol::json_text(protocol::to_json(*parsed)));
  if (!again || !(*again == *parsed)) fail("written differently from what was read");
  plan(*parsed);
  return 0;
}
