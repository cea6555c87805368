// What a viewer is sent. All is called with the lock held, save `next`, which takes it.
#include <algorithm>
#include <utility>

#include "protocol/frame_header.h"
#include "server/stream/viewer.h"

namespace lightwell {
namespace {

using std::chrono::steady_clock;

constexpr auto kStatsInterval = std::chrono::milliseconds(250);
constexpr std::size_t kMostTexts = 64;  // that wait: more, and the client asks without reading the answers

/// RFC 6455 leaves 123 bytes for a close frame's reason, which must be whole UTF-8.
std::string close_reason(const std::string& text) {
  std::size_t size = std::min<std::size_t>(text.size(), 123);
  while (size < text.size() && size > 0 && (static_cast<unsigned char>(text[size]) & 0xc0) == 0x80) --size;
  return text.substr(0, size);
}

}  // namespace

net::Outgoing Viewer::next() {
  std::lock_guard lock(mutex_);
  if (!texts_.empty()) {
    net::TextMessage text{std::move(texts_.front())};
    texts_.pop_front();
    return text;
  }
  if (closing_) return *closing_;
  if (stage_ != Stage::kWatching) return {};
  if (changed_members_ != 0) return net::TextMessage{take_state_update()};
  if (!may_send_picture()) return {};
  if (*waiting_->placement != *placement_) return net::TextMessage{take_placement()};
  return take_picture();
}

/// For a picture on the way.
bool Viewer::has_room() const {
  return static_cast<int>(in_flight_.size()) < pace_.most_on_the_way();
}

bool Viewer::may_send_picture() const {
  return waiting_ && stage_ == Stage::kWatching && has_room();
}

void Viewer::wake() {
  if (link_) link_->wake();
}

void Viewer::queue_text(const protocol::ServerMessage& message) {
  if (stage_ == Stage::kEnding || stage_ == Stage::kClosed) return;
  if (texts_.size() >= kMostTexts)
    return queue_end(protocol::CloseCode::kBadMessage, "more is asked than answers are read", true);
  texts_.push_back(protocol::serialize(message));
  wake();
}

void Viewer::queue_end(protocol::CloseCode code, const std::string& reason, bool reconnect) {
  if (stage_ == Stage::kEnding || stage_ == Stage::kClosed) return;
  texts_.push_back(protocol::serialize(protocol::Bye{reason, reconnect}));
  closing_ = net::CloseMessage{static_cast<std::uint16_t>(code), close_reason(reason)};
  stage_ = Stage::kEnding;
  ending_since_ = steady_clock::now();
  waiting_.reset();
  wake();
}

std::string Viewer::take_state_update() {
  protocol::StateUpdate update = host_->change_of(std::exchange(changed_members_, 0u));
  update.seq = std::exchange(changed_by_seq_, std::nullopt);
  return protocol::serialize(update);
}

std::string Viewer::take_placement() {
  placement_ = waiting_->placement;
  return protocol::serialize(protocol::PoseUpdate{last_frame_ + 1, placement_->view, placement_->lights});
}

/// Whether it can be decoded after what was sent.
bool Viewer::follows_on(const VideoPacket& packet) const {
  return packet.is_key || (video_index_ > 0 && packet.index == video_index_ + 1);
}

net::Outgoing Viewer::take_picture() {
  const std::shared_ptr<const Picture> picture = std::move(waiting_);
  const SteadyTime now = steady_clock::now();
  const bool as_video = picture->video && has_video_ && follows_on(*picture->video);
  if (picture->video) video_index_ = as_video ? picture->video->index : 0;
  if (!as_video && !picture->file) return {};  // the next one is made for this viewer too
  const auto& payload = as_video ? picture->video->bytes : picture->file;
  note_shown_inputs(picture->revision);
  protocol::FrameHeader header;
  header.codec = as_video ? protocol::FrameCodec::kH264 : protocol::FrameCodec::kJpeg;
  header.is_key = !as_video || picture->video->is_key;
  header.is_final = picture->is_final;
  header.frame = ++last_frame_;
  header.input_seq = shown_seq_;
  header.scene_revision = picture->scene_revision;
  header.capture_ms = picture->capture_ms;
  header.scene_time_s = static_cast<float>(picture->stats.time_s);
  header.width = picture->width;
  header.height = picture->height;
  header.payload_bytes = static_cast<std::uint32_t>(payload->size());
  header.render_ms = static_cast<float>(picture->stats.render_ms);
  in_flight_.push_back({last_frame_, now, static_cast<double>(payload->size())});
  sent_times_.push_back(now);
  queue_stats(*picture, now);
  host_->picture_sent(as_video ? PictureCodec::kH264 : PictureCodec::kJpeg, payload->size());
  const auto bytes = protocol::encode_frame_header(header);
  return net::BinaryMessage{std::string(bytes.begin(), bytes.end()), payload};
}

void Viewer::note_arrival(const Sent& sent, const protocol::Ack& ack, SteadyTime now) {
  const auto seconds_since = [now](SteadyTime then) { return std::chrono::duration<double>(now - then).count(); };
  host_->picture_acknowledged(seconds_since(sent.at));
  if (!ack.held_ms) {
    const double gap_s = sent.at < last_arrival_ ? seconds_since(last_arrival_) : 0.0;
    const double sent_s = std::chrono::duration<double>(sent.at.time_since_epoch()).count();
    pace_.arrived({sent.bytes, sent_s, seconds_since(sent.at), gap_s});
  }
  last_arrival_ = now;
}

void Viewer::note_shown_inputs(std::uint64_t revision) {
  while (!applied_.empty() && applied_.front().revision <= revision) {
    shown_seq_ = applied_.front().seq;
    applied_.pop_front();
  }
}

void Viewer::queue_stats(const Picture& picture, SteadyTime now) {
  while (now - sent_times_.front() > std::chrono::seconds(1)) sent_times_.pop_front();
  if (now - stats_sent_ < kStatsInterval && !picture.is_final) return;
  stats_sent_ = now;
  protocol::Stats stats = picture.stats;
  const double span_s = std::chrono::duration<double>(now - sent_times_.front()).count();
  stats.fps = span_s > 0.0 ? static_cast<double>(sent_times_.size() - 1) / span_s : 0.0;
  texts_.push_back(protocol::serialize(stats));
}

}  // namespace lightwell
