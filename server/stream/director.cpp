#include "server/stream/director.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "server/convert.h"
#include "server/operations/log.h"

namespace lightwell {
namespace {

using std::chrono::steady_clock;

constexpr auto kDevicePause = std::chrono::milliseconds(500);  // after the device was lost
constexpr std::chrono::duration<double> kNearlyDone(0.008);    // a picture with no more to do is finished all the same
constexpr auto kKeyInterval = std::chrono::seconds(2);         // between keys of video that were asked for
constexpr int kSmallPicture = 256 * 256;                       // pixels: halved chroma saves little and shows

}  // namespace

Director::Director(std::shared_ptr<DirectedSession> session, WorkerPool& encoders, const DirectorOptions& options)
    : session_(std::move(session)), encoders_(encoders), options_(options), grader_(options.quality) {}

SteadyTime Director::due_at(SteadyTime now) {
  const std::shared_ptr<const SessionState> state = session_->state();
  if (state->revision == failed_revision_) return kNever;  // it would fail again
  if (now < retry_at_) return retry_at_;
  if (!session_->audience().wants_picture(in_the_making_)) return kNever;
  const SteadyTime next_frame = started_ + std::max(options_.least_frame_time, take_.grade.interval);
  if (!take_.state || state->revision != take_.state->revision)
    return take_.kind == Kind::kFresh ? next_frame : now;  // refining gives way at once
  if (state->moving()) return next_frame;
  if (accumulated_ < frames_wanted()) return still_since_ + options_.still_before_refining;
  return goes_over_into_reference() ? still_since_ + options_.still_before_reference : kNever;
}

bool Director::goes_over_into_reference() const {
  const Settings& settings = take_.request.settings;
  return options_.still_before_reference.count() > 0 && settings.hand_over && !in_reference_ &&
         settings.method != Method::kReference && every_method_shows(settings.view);
}

std::uint32_t Director::frames_wanted() const {
  const bool reference = in_reference_ || take_.request.settings.method == Method::kReference;
  return reference ? options_.reference_frames : options_.refining_frames;
}

Result<Shot> Director::take_shot(SteadyTime now) {
  std::shared_ptr<const SessionState> state = session_->state();
  const bool same = take_.state && take_.state->revision == state->revision && !state->moving();
  take_.kind = same && accumulated_ > 0 ? Kind::kRefining : Kind::kFresh;
  take_.state = std::move(state);
  take_.start = now;
  last_started_ = std::exchange(started_, now);
  ++in_the_making_;
  if (take_.kind == Kind::kFresh) return take_fresh_shot();
  if (accumulated_ >= frames_wanted()) {  // the method's own final picture has stood long enough
    in_reference_ = true;
    accumulated_ = 0;
  }
  return take_refining_shot();
}

Result<Shot> Director::take_fresh_shot() {
  const SessionState& state = *take_.state;
  still_since_ = take_.start;
  in_reference_ = false;
  FrameRequest request;
  request.time_s = state.clock.time_s(take_.start);
  take_.grade = choose_grade();
  request.size_px = take_.grade.scaled(state.size_px);
  request.settings = state.settings;
  auto camera = state.stage->place(state.camera, request.time_s, state.aspect_ratio());
  if (!camera) return invalid_input(camera.problem().pointer, camera.problem().detail);
  request.camera = std::move(camera).value();
  take_.request = request;
  take_.method = request.settings.method;
  take_.shown = true;
  take_.is_final = false;
  if (state.revision == finished_revision_) request.is_unwanted = gives_way_to_inputs();
  return Shot{state.stage->scene(), std::move(request)};
}

/// For a picture in which only time has gone on: an input that comes meanwhile is shown sooner without it. The picture
/// that shows the input is finished whatever comes, so that never two in a row are given up.
std::function<bool()> Director::gives_way_to_inputs() const {
  const auto nearly_done = take_.start + std::chrono::duration_cast<SteadyTime::duration>(usual_time_ - kNearlyDone);
  return [session = session_, revision = take_.state->revision, nearly_done] {
    return session->state()->revision != revision && steady_clock::now() < nearly_done;
  };
}

PictureGrade Director::choose_grade() {
  const LinkPace pace = session_->audience().pace();
  std::lock_guard lock(grader_mutex_);
  return grader_.choose(pace);
}

/// The very same again, added to what is there; from the beginning if that was smaller than asked for. Pictures are
/// shown at every doubling: each then has visibly less noise. Where `reference` takes over, its paths come into the
/// picture that stands little by little.
Shot Director::take_refining_shot() {
  if (take_.request.size_px != take_.state->size_px) {
    take_.request.size_px = take_.state->size_px;
    accumulated_ = 0;
  }
  const std::uint32_t frames = accumulated_ + 1;
  take_.is_final = frames >= frames_wanted();
  take_.shown = take_.is_final || std::has_single_bit(frames);
  FrameRequest request = take_.request;
  if (in_reference_) {
    request.settings.method = Method::kReference;
    request.hand_over_frames = frames_wanted();
  }
  take_.method = request.settings.method;
  request.accumulate = accumulated_ > 0;
  request.is_unwanted = [session = session_, revision = take_.state->revision] {
    return session->state()->revision != revision;
  };
  request.want_display = take_.shown;
  return Shot{take_.state->stage->scene(), std::move(request)};
}

void Director::shot_done(Result<Frame> frame) {
  if (!frame) {
    --in_the_making_;
    accumulated_ = 0;
    if (frame.error().kind == ErrorKind::kUnwanted) {
      started_ = last_started_;  // the next need not wait for its turn
      return;
    }
    if (session_->state()->revision != take_.state->revision) return;  // what failed is out of date
    const bool lost = frame.error().kind == ErrorKind::kDeviceLost;    // not the picture's fault
    if (lost)
      retry_at_ = steady_clock::now() + kDevicePause;
    else
      failed_revision_ = take_.state->revision;
    return session_->audience().report(problem_of(frame.error()));
  }
  finished_revision_ = take_.state->revision;
  if (take_.kind == Kind::kFresh) usual_time_ = steady_clock::now() - take_.start;
  accumulated_ = take_.kind == Kind::kFresh ? 1 : frame->accumulated;
  if (take_.shown) return encode(std::move(frame).value());
  --in_the_making_;
}

void Director::encode(Frame frame) {
  auto shared = std::make_shared<const Frame>(std::move(frame));
  const std::uint64_t number = next_number_++;
  // Counted down whatever becomes of the work: done, failed or dropped.
  const std::shared_ptr<void> made(nullptr, [self = shared_from_this()](void*) {
    --self->in_the_making_;
    self->session_->wake_render_loop();
  });
  encoders_.try_post([this, made, take = take_, shared, number] { show(take, *shared, number); });
}

/// What moves is video for those who take it. A key is large, and all who take video get it: however often someone
/// falls behind or comes anew, they are rare, and who waits for one has files.
PictureNeed Director::need_of(const Take& take, const Frame& frame, SteadyTime now) const {
  PictureNeed need = session_->audience().need();
  if (take.kind != Kind::kFresh || !need.video || !VideoEncoder::takes(frame.size_px)) return {.jpeg = true};
  if (need.key && now - last_key_at_.load() < kKeyInterval) {
    need.key = false;
    need.jpeg = true;
  }
  return need;
}

/// None where the encoder fails: those who watch have JPEG from here on.
std::optional<VideoPacket> Director::encode_video(const Take& take, const Frame& frame, bool want_key) {
  Result<VideoPacket> packet =
      options_.encode.video(video_, frame.display_rgbx, frame.size_px, take.grade.quality, want_key);
  if (packet) {
    if (packet->is_key) last_key_at_ = steady_clock::now();
    return std::move(packet).value();
  }
  log_event(LogLevel::kError, "video_failed", {{"reason", packet.error().message()}});
  session_->encoding_failed(PictureCodec::kH264);
  session_->audience().demote(
      protocol::make_problem(500, "video cannot be encoded any more: pictures are JPEG from here on"));
  return {};
}

/// False where the encoder fails: the same would fail again, so that nothing is made until something changes.
bool Director::encode_file(const Take& take, const Frame& frame, Picture& picture) {
  const bool moving = take.kind == Kind::kFresh && frame.size_px.x * frame.size_px.y > kSmallPicture;
  auto file = options_.encode.jpeg(frame.display_rgbx, frame.size_px,
                                   take.is_final ? options_.final_quality : take.grade.quality,
                                   moving ? Chroma::kHalved : Chroma::kFull);
  if (!file) {
    log_event(LogLevel::kError, "picture_not_encoded", {{"reason", file.error().message()}});
    session_->encoding_failed(PictureCodec::kJpeg);
    if (session_->state()->revision != take.state->revision) return false;  // what failed is out of date
    failed_revision_ = take.state->revision;
    session_->audience().report(problem_of(file.error()));
    return false;
  }
  picture.file = std::make_shared<const std::vector<std::uint8_t>>(std::move(file).value());
  return true;
}

/// On an encoder's thread.
void Director::show(const Take& take, const Frame& frame, std::uint64_t number) {
  const SteadyTime start = steady_clock::now();
  const PictureNeed need = need_of(take, frame, start);
  auto picture = std::make_shared<Picture>();
  if (need.jpeg && !encode_file(take, frame, *picture)) return;
  std::lock_guard in_order(show_mutex_);
  if (number < shown_number_) return;
  shown_number_ = number;
  if (need.video) picture->video = encode_video(take, frame, need.key);
  if (take.is_final) video_.rest();
  if (!picture->video && !picture->file && !encode_file(take, frame, *picture)) return;

  const bool video_counts = picture->video && (need.is_paced_by_video || !picture->file);
  const std::size_t bytes = video_counts ? picture->video->bytes->size() : picture->file->size();
  if (take.kind == Kind::kFresh) {
    std::lock_guard lock(grader_mutex_);
    grader_.made(take.grade, static_cast<double>(bytes), frame.total_ms * 1e-3);
  }
  picture->number = number;
  describe(take, frame, *picture);
  picture->stats.encode_ms = std::chrono::duration<double, std::milli>(steady_clock::now() - start).count();
  session_->picture_encoded(picture->stats.encode_ms * 1e-3, {picture->file ? picture->file->size() : 0,
                                                              picture->video ? picture->video->bytes->size() : 0});
  session_->audience().show(std::move(picture));
}

/// Everything but the picture itself.
void Director::describe(const Take& take, const Frame& frame, Picture& picture) const {
  picture.source = session_->audience().source();
  picture.revision = take.state->revision;
  picture.scene_revision = take.state->revision - take.state->looks;
  picture.is_final = take.is_final;
  picture.capture_ms = std::chrono::duration<double, std::milli>(take.start.time_since_epoch()).count();
  picture.width = static_cast<std::uint16_t>(frame.size_px.x);
  picture.height = static_cast<std::uint16_t>(frame.size_px.y);
  const StagedScene& stage = *take.state->stage;
  picture.placement = std::make_shared<const Placement>(
      Placement{view_at(*take.state, take.request.time_s), stage.lights(take.request.time_s)});
  protocol::Stats& stats = picture.stats;
  for (const StageTime& stage_time : frame.stages)
    stats.stages.push_back({std::string(stage_time.name), stage_time.ms});
  stats.render_ms = frame.total_ms;
  stats.rays = frame.rays;
  stats.triangles = frame.triangles;
  stats.exposure_ev = frame.exposure_ev;
  stats.accumulated = frame.accumulated;
  stats.clamped_share = frame.clamped_share;
  stats.method = name_of(take.method);
  stats.time_s = take.request.time_s;
}

}  // namespace lightwell
