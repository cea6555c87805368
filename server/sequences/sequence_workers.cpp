#include "server/sequences/sequence_workers.h"

#include <fmt/format.h>

#include "protocol/json_text.h"
#include "protocol/names.h"
#include "renderer/image_io/image_io.h"
#include "server/convert.h"
#include "server/operations/log.h"
#include "server/render/encode_picture.h"
#include "server/render/render_job.h"

namespace lightwell {
namespace {

using protocol::Decoded;
using protocol::ImageFormat;

constexpr int kThreads = 2;
constexpr auto kWait = std::chrono::milliseconds(250);  // for work; and for what other servers leave
constexpr auto kReadyPoll = std::chrono::milliseconds(50);

/// Not the sequence's fault: another try may do.
constexpr int kTryAgain = 503;

std::string file_name(std::uint32_t frame, const std::string& view, ImageFormat format) {
  const std::string_view ending = format == ImageFormat::kJpeg ? "jpg" : protocol::name_of(format);
  return fmt::format("{:06}{}{}.{}", frame, view.empty() ? "" : ".", view, ending);
}

/// The settings travel in the picture, so that it can be made again.
std::map<std::string, std::string> metadata_of(const SequencePlan& plan, std::uint32_t frame) {
  return {{"lightwell:frame", std::to_string(frame)},
          {"lightwell:request", protocol::json_text(protocol::to_json(plan.request()))}};
}

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

}  // namespace

SequenceWorkers::SequenceWorkers(SequenceStore& store, RenderLoop& render_loop, Metrics& metrics)
    : store_(store), render_loop_(render_loop), task_("sequence_frames", metrics) {
  for (int i = 0; i < kThreads; ++i) threads_.emplace_back([this] { run(); });
}

SequenceWorkers::~SequenceWorkers() {
  stopping_ = true;
  store_.stop();
  for (std::thread& thread : threads_) thread.join();
}

void SequenceWorkers::run() {
  while (!stopping_ && !render_loop_.is_ready()) std::this_thread::sleep_for(kReadyPoll);
  std::optional<ClaimedFrame> frame;
  while (!stopping_)
    if (!task_.attempt([&] { work(frame); })) std::this_thread::sleep_for(kWait);
}

void SequenceWorkers::work(std::optional<ClaimedFrame>& frame) {
  if (frame) store_.release(*frame);  // the table failed while it was made: it is made again
  frame.reset();
  frame = store_.claim(kWait);
  if (!frame) return;
  try {
    render(*frame);
  } catch (const DatabaseError&) {
    throw;
  } catch (const std::exception&) {  // no memory, say: it would fail again
    store_.fail(*frame, protocol::make_problem(500, "the frame could not be kept"));
    frame.reset();
    throw;
  }
  frame.reset();
}

void SequenceWorkers::render(const ClaimedFrame& frame) {
  const auto given_up = store_.given_up(frame.sequence);
  const auto plan = store_.plan(frame.sequence);
  if (!plan) return store_.fail(frame, plan.problem());
  const auto files = make_files(frame, **plan, given_up);
  if (files) return store_.finish(frame, *files);
  if (*given_up || stopping_ || files.problem().status == kTryAgain) return store_.release(frame);
  store_.fail(frame, files.problem());
}

Decoded<std::vector<FrameFile>> SequenceWorkers::make_files(const ClaimedFrame& claimed, const SequencePlan& plan,
                                                            const std::shared_ptr<std::atomic<bool>>& given_up) {
  const protocol::SequenceRequest& request = plan.request();
  std::vector<FrameFile> files;
  const auto keep = [&](const std::string& name,
                        const Result<std::string>& encoded) -> std::optional<protocol::Problem> {
    if (!encoded) return problem_of(encoded.error());
    const Status written = store_.folder().write(claimed.sequence, name, bytes_of(*encoded));
    if (!written) log_event(LogLevel::kError, "frame_not_written", {{"reason", written.error().message()}});
    if (!written) return protocol::make_problem(500, "the frame could not be kept");
    files.push_back({name, encoded->size(), crc32_of(bytes_of(*encoded))});
    return {};
  };
  std::vector<ExrLayer> layers;
  std::vector<Frame> frames;  // what the layers show
  frames.reserve(plan.views());
  for (std::size_t view = 0; view < plan.views(); ++view) {
    auto shot = plan.shot(claimed.number, view);
    if (!shot) return shot.problem();
    auto job = std::make_shared<RenderJob>(std::move(shot).value(), request.spp_frames, given_up);
    std::future<Result<Frame>> result = job->result();
    render_loop_.add(std::move(job), Share::kJobs);
    Result<Frame> frame = result.get();
    if (!frame) return problem_of(frame.error());
    if (request.format != ImageFormat::kExr) {
      const std::string name = file_name(claimed.number, request.views[view], request.format);
      if (auto problem = keep(name, encode_picture(*frame, request.format))) return *problem;
      continue;
    }
    frames.push_back(std::move(frame).value());
    layers.push_back({request.views[view] == "final" ? "" : request.views[view], frames.back().linear_rgb});
  }
  if (layers.empty()) return files;
  const auto exr = encode_exr_layers({request.width, request.height}, layers, metadata_of(plan, claimed.number));
  if (!exr) return problem_of(exr.error());
  const std::string text(reinterpret_cast<const char*>(exr->data()), exr->size());
  if (auto problem = keep(file_name(claimed.number, "", request.format), text)) return *problem;
  return files;
}

}  // namespace lightwell
