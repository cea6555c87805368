#include "server/stream/viewer.h"

#include <utility>

#include "server/operations/log.h"
#include "server/random_id.h"

namespace lightwell {
namespace {

using protocol::Problem;
using std::chrono::steady_clock;

constexpr auto kPatience = std::chrono::seconds(10);        // with a client that acknowledges nothing, or says no hello
constexpr auto kClosingPatience = std::chrono::seconds(3);  // with one that does not even read the end
constexpr std::size_t kMostInputs = 4096;                   // remembered until a picture shows them

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
  const nlohmann::json type = json && json->is_object() ? json->value("type", nlohmann::json()) : nlohmann::json();
  const nlohmann::json seq =
      type == "input" || type == "look" ? json->value("seq", nlohmann::json()) : nlohmann::json();
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
    has_video_ = welcome->codec == "h264";
    placement_ = std::make_shared<const Placement>(Placement{welcome->view, welcome->lights});
    queue_text(*welcome);
    if (stage_ == Stage::kAwaitingHello) stage_ = Stage::kWatching;
  }
  host_->window_opened();
}

void Viewer::received(const protocol::Input& input) {
  if (drives_) return take_numbered(input, &ViewerHost::apply_input);
  std::lock_guard lock(mutex_);
  queue_text(protocol::ErrorMessage{
      protocol::make_problem(403, "a viewer only watches: its inputs are not taken, but it may look for itself"),
      input.seq});
}

void Viewer::received(const protocol::Look& look) {
  if (!drives_) return take_numbered(look, &ViewerHost::apply_look);
  std::lock_guard lock(mutex_);
  queue_text(protocol::ErrorMessage{
      protocol::make_problem(422, "a driver looks as the session does: its camera and size are inputs"), look.seq});
}

template <class Message>
void Viewer::take_numbered(const Message& message,
                           std::optional<Problem> (ViewerHost::*apply)(const Message&, Viewer&)) {
  std::optional<Problem> problem;
  if (message.seq <= last_seq_) {
    problem = protocol::make_problem(422, "seq does not ascend", "/seq");
  } else {
    last_seq_ = message.seq;
    problem = (host_.get()->*apply)(message, *this);
  }
  if (!problem) return;
  std::lock_guard lock(mutex_);
  queue_text(protocol::ErrorMessage{*problem, message.seq});
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

void Viewer::received(const protocol::Demotion& demotion) {
  {
    std::lock_guard lock(mutex_);
    if (!has_video_) return;  // said once a stream, whatever the client repeats
    has_video_ = false;
  }
  log_event(LogLevel::kWarning, "video_given_up", {{"reason", demotion.reason}});
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
  if (picture->source != source_ || (waiting_ && waiting_->number > picture->number)) return;
  waiting_ = std::move(picture);
  if (may_send_picture()) wake();
}

void Viewer::watch(std::uint64_t source, bool own_camera) {
  std::lock_guard lock(mutex_);
  if (source_ != source) {
    waiting_.reset();
    video_index_ = 0;
  }
  source_ = source;
  own_camera_ = own_camera;
}

std::uint64_t Viewer::source() const {
  std::lock_guard lock(mutex_);
  return source_;
}

void Viewer::input_applied(std::uint64_t revision, std::uint32_t seq) {
  std::lock_guard lock(mutex_);
  // Another source counts otherwise: what would be shown later is so in the same picture at the latest.
  while (!applied_.empty() && applied_.back().revision > revision) applied_.pop_back();
  applied_.push_back({revision, seq});
  if (applied_.size() > kMostInputs) applied_.pop_front();
}

void Viewer::state_changed(unsigned members, std::optional<std::uint32_t> seq) {
  std::lock_guard lock(mutex_);
  if (seq || own_camera_) members &= ~kChangedCamera;  // nobody knows it better than who moves it
  members &= ~kChangedSize;
  if (members == 0) return;
  if (seq) changed_by_seq_ = seq;
  changed_members_ |= members;
  wake();
}

PictureNeed Viewer::need() const {
  std::lock_guard lock(mutex_);
  if (stage_ != Stage::kWatching) return {};
  PictureNeed need;
  need.jpeg = !has_video_;
  need.video = has_video_;
  need.key = has_video_ && video_index_ == 0 && has_room();  // else it could not be sent now
  return need;
}

void Viewer::demote(const Problem& problem) {
  std::lock_guard lock(mutex_);
  if (!has_video_) return;
  has_video_ = false;
  queue_text(protocol::ErrorMessage{problem, {}});
}

void Viewer::report(const Problem& problem) {
  std::lock_guard lock(mutex_);
  queue_text(protocol::ErrorMessage{problem, {}});
}

void Viewer::end(protocol::CloseCode code, const std::string& reason, bool reconnect) {
  std::lock_guard lock(mutex_);
  queue_end(code, reason, reconnect);
}

bool Viewer::takes_another(int in_the_making) const {
  std::lock_guard lock(mutex_);
  const int there = static_cast<int>(in_flight_.size()) + (waiting_ ? 1 : 0) + in_the_making;
  return stage_ == Stage::kWatching && there < pace_.most_on_the_way();
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

}  // namespace lightwell
