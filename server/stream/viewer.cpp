#include "server/stream/viewer.h"

#include <algorithm>
#include <utility>

#include "protocol/frame_header.h"
#include "server/random_id.h"

namespace lightwell {
namespace {

using protocol::Problem;
using std::chrono::steady_clock;

constexpr auto kPatience = std::chrono::seconds(10);        // with a client that acknowledges nothing, or says no hello
constexpr auto kClosingPatience = std::chrono::seconds(3);  // with one that does not even read the end
constexpr auto kStatsInterval = std::chrono::milliseconds(250);
constexpr std::size_t kMostTexts = 64;     // that wait: more, and the client asks without reading the answers
constexpr std::size_t kMostInputs = 4096;  // remembered until a picture shows them

/// RFC 6455 leaves 123 bytes for a close frame's reason, which must be whole UTF-8.
std::string close_reason(const std::string& text) {
  std::size_t size = std::min<std::size_t>(text.size(), 123);
  while (size < text.size() && size > 0 && (static_cast<unsigned char>(text[size]) & 0xc0) == 0x80) --size;
  return text.substr(0, size);
}

}  // namespace

double server_clock_ms() {
  return std::chrono::duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

Viewer::Viewer(std::shared_ptr<ViewerHost> host, bool may_drive)
    : host_(std::move(host)), may_drive_(may_drive), resume_token_(random_id()), created_(steady_clock::now()) {}

// What the connection brings.

void Viewer::opened(std::shared_ptr<net::WebSocketLink> link) {
  std::lock_guard lock(mutex_);
  link_ = std::move(link);
  if (!texts_.empty() || closing_) wake();
}

void Viewer::received_text(std::string_view text) {
  const protocol::Decoded<protocol::ClientMessage> message = protocol::parse_client_message(text);
  if (!message) return refuse_text(text, message.problem());
  const bool is_hello = std::holds_alternative<protocol::Hello>(*message);
  {
    std::lock_guard lock(mutex_);
    if (stage_ == Stage::kEnding || stage_ == Stage::kClosed) return;
    if (is_hello != (stage_ == Stage::kAwaitingHello))
      return queue_end(protocol::CloseCode::kBadMessage, "the first message, and only it, is a hello", false);
  }
  std::visit([this](const auto& known) { received(known); }, *message);
}

void Viewer::received_binary(std::string_view) {
  bad_message("a client sends no binary messages");
}

void Viewer::refuse_text(std::string_view text, const Problem& problem) {
  if (problem.status != 422) return bad_message(problem.detail);
  const auto json = protocol::parse_json(text);
  const bool is_input = json && json->is_object() && json->value("type", nlohmann::json()) == "input";
  const nlohmann::json seq = is_input ? json->value("seq", nlohmann::json()) : nlohmann::json();
  const bool has_seq = seq.is_number_unsigned() && seq.get<std::uint64_t>() <= 0xffffffffu;
  std::lock_guard lock(mutex_);
  if (!has_seq || stage_ != Stage::kWatching)
    return queue_end(protocol::CloseCode::kBadMessage, problem.pointer + ": " + problem.detail, false);
  queue_text(protocol::ErrorMessage{problem, seq.get<std::uint32_t>()});
}

void Viewer::bad_message(const std::string& reason) {
  end(protocol::CloseCode::kBadMessage, reason, false);
}

void Viewer::received(const protocol::Hello& hello) {
  protocol::Decoded<protocol::Welcome> welcome = host_->greet(hello, *this);
  {
    std::lock_guard lock(mutex_);
    if (!welcome) {
      queue_text(protocol::ErrorMessage{welcome.problem(), {}});
      return queue_end(protocol::CloseCode::kNotAllowed, welcome.problem().detail, false);
    }
    welcome->resume = resume_token_;
    drives_ = welcome->role == protocol::Role::kDriver;
    placement_ = std::make_shared<const Placement>(Placement{welcome->view, welcome->lights});
    queue_text(*welcome);
    if (stage_ == Stage::kAwaitingHello) stage_ = Stage::kWatching;
  }
  host_->window_opened();
}

void Viewer::received(const protocol::Input& input) {
  std::optional<Problem> problem;
  if (!drives_)
    problem = protocol::make_problem(403, "a viewer only watches: its inputs are not taken");
  else if (input.seq <= last_seq_)
    problem = protocol::make_problem(422, "seq does not ascend", "/seq");
  else {
    last_seq_ = input.seq;
    problem = host_->apply_input(input, *this);
  }
  if (!problem) return;
  std::lock_guard lock(mutex_);
  queue_text(protocol::ErrorMessage{*problem, input.seq});
}

void Viewer::received(const protocol::Ack& ack) {
  {
    std::lock_guard lock(mutex_);
    if (ack.frame > last_frame_)
      return queue_end(protocol::CloseCode::kBadMessage, "an ack of a frame that was never sent", false);
    for (; !in_flight_.empty() && in_flight_.front().frame <= ack.frame; in_flight_.pop_front())
      if (in_flight_.front().frame == ack.frame) note_arrival(in_flight_.front(), ack, steady_clock::now());
    if (waiting_) wake();
  }
  host_->window_opened();
}

void Viewer::received(const protocol::Ping& ping) {
  std::lock_guard lock(mutex_);
  queue_text(protocol::Pong{ping.t});
}

void Viewer::closed() {
  {
    std::lock_guard lock(mutex_);
    stage_ = Stage::kClosed;
    link_.reset();
  }
  host_->leave(*this);
}

// What others bring.

void Viewer::offer(std::shared_ptr<const Picture> picture) {
  std::lock_guard lock(mutex_);
  if (waiting_ && waiting_->number > picture->number) return;
  waiting_ = std::move(picture);
  if (may_send_picture()) wake();
}

void Viewer::input_applied(std::uint64_t revision, std::uint32_t seq) {
  std::lock_guard lock(mutex_);
  applied_.push_back({revision, seq});
  if (applied_.size() > kMostInputs) applied_.pop_front();
}

void Viewer::state_changed(unsigned members, std::optional<std::uint32_t> seq) {
  std::lock_guard lock(mutex_);
  if (seq) members &= ~kChangedCamera;  // nobody knows it better than who moved it
  members &= ~kChangedSize;
  if (members == 0) return;
  if (seq) changed_by_seq_ = seq;
  changed_members_ |= members;
  wake();
}

void Viewer::report(const Problem& problem) {
  std::lock_guard lock(mutex_);
  queue_text(protocol::ErrorMessage{problem, {}});
}

void Viewer::end(protocol::CloseCode code, const std::string& reason, bool reconnect) {
  std::lock_guard lock(mutex_);
  queue_end(code, reason, reconnect);
}

int Viewer::pictures_on_the_way() const {
  std::lock_guard lock(mutex_);
  return static_cast<int>(in_flight_.size()) + (waiting_ ? 1 : 0);
}

LinkPace Viewer::pace() const {
  std::lock_guard lock(mutex_);
  return pace_;
}

bool Viewer::drives() const {
  std::lock_guard lock(mutex_);
  return drives_ && stage_ == Stage::kWatching;
}

bool Viewer::watching() const {
  std::lock_guard lock(mutex_);
  return stage_ == Stage::kWatching;
}

void Viewer::check_patience(SteadyTime now) {
  std::lock_guard lock(mutex_);
  if (stage_ == Stage::kAwaitingHello && now - created_ > kPatience)
    queue_end(protocol::CloseCode::kBadMessage, "no hello came", false);
  if (stage_ == Stage::kWatching && !in_flight_.empty() && now - in_flight_.front().at > kPatience)
    queue_end(protocol::CloseCode::kTooSlow, "a frame was not acknowledged within 10 seconds", true);
  if (stage_ == Stage::kEnding && now - ending_since_ > kClosingPatience && link_) link_->abort();
}

// What is sent. All that follows is called with the lock held, save `next`, which takes it.

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

bool Viewer::may_send_picture() const {
  return waiting_ && stage_ == Stage::kWatching && in_flight_.size() < kMostInFlight;
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

net::Outgoing Viewer::take_picture() {
  const std::shared_ptr<const Picture> picture = std::move(waiting_);
  const SteadyTime now = steady_clock::now();
  note_shown_inputs(picture->revision);
  protocol::FrameHeader header;
  header.is_final = picture->is_final;
  header.frame = ++last_frame_;
  header.input_seq = shown_seq_;
  header.scene_revision = picture->revision;
  header.capture_ms = picture->capture_ms;
  header.scene_time_s = static_cast<float>(picture->stats.time_s);
  header.width = picture->width;
  header.height = picture->height;
  header.payload_bytes = static_cast<std::uint32_t>(picture->file->size());
  header.render_ms = static_cast<float>(picture->stats.render_ms);
  const auto bytes_sent = static_cast<double>(picture->file->size());
  const double before = in_flight_.empty() ? 0.0 : in_flight_.back().bytes;
  in_flight_.push_back({last_frame_, now, bytes_sent, before + bytes_sent});
  sent_times_.push_back(now);
  queue_stats(*picture, now);
  host_->picture_sent(picture->file->size());
  const auto bytes = protocol::encode_frame_header(header);
  return net::BinaryMessage{std::string(bytes.begin(), bytes.end()), picture->file};
}

void Viewer::note_arrival(const Sent& sent, const protocol::Ack& ack, SteadyTime now) {
  const auto seconds_since = [now](SteadyTime then) { return std::chrono::duration<double>(now - then).count(); };
  host_->picture_acknowledged(seconds_since(sent.at));
  if (!ack.held_ms) {
    const double gap_s = sent.at < last_arrival_ ? seconds_since(last_arrival_) : 0.0;
    pace_.arrived({sent.bytes, sent.bytes_on_the_way, seconds_since(sent.at), gap_s});
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
