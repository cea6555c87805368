// One stream of a session: what has been sent, what is in flight, what is to be sent next. Never more than the newest
// of anything waits for a slow client.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "protocol/codec.h"
#include "server/net/application.h"
#include "server/operations/metrics.h"
#include "server/session/session_state.h"
#include "server/stream/link_pace.h"
#include "server/stream/picture.h"

namespace lightwell {

class Viewer;

/// What a viewer asks of its session. Called without the viewer's lock.
class ViewerHost {
 public:
  virtual ~ViewerHost() = default;
  /// Answers a hello. A problem ends the stream.
  virtual protocol::Decoded<protocol::Welcome> greet(const protocol::Hello& hello, Viewer& viewer) = 0;
  virtual std::optional<protocol::Problem> apply_input(const protocol::Input& input, Viewer& by) = 0;
  /// Only viewers that do not drive look for themselves.
  virtual std::optional<protocol::Problem> apply_look(const protocol::Look& look, Viewer& by) = 0;
  /// What viewers are told when these members have changed.
  virtual protocol::StateUpdate change_of(unsigned members) const = 0;
  virtual void picture_sent(PictureCodec codec, std::uint64_t bytes) = 0;
  /// So many seconds after it was sent.
  virtual void picture_acknowledged(double seconds) = 0;
  /// The viewer can take a picture again.
  virtual void window_opened() = 0;
  virtual void leave(Viewer& viewer) = 0;
};

class Viewer : public net::WebSocketHandler, public std::enable_shared_from_this<Viewer> {
 public:
  /// `may_drive`: its client's token allows it.
  Viewer(std::shared_ptr<ViewerHost> host, bool may_drive);

  // From the connection, one call at a time.
  void opened(std::shared_ptr<net::WebSocketLink> link) override;
  void received_text(std::string_view text) override;
  void received_binary(std::string_view bytes) override;
  net::Outgoing next() override;
  void closed() override;

  // From any thread.

  /// From here on it sees the pictures of this source alone (Audience::source), with a camera of its own or the
  /// session's.
  void watch(std::uint64_t source, bool own_camera);
  std::uint64_t source() const;
  /// A newer picture of a source than any before; passed over if it is not the one watched. Replaces one that waits.
  void offer(std::shared_ptr<const Picture> picture);
  /// The input `seq` of this viewer is in pictures of `revision` and later ones. Told before any of them is made.
  void input_applied(std::uint64_t revision, std::uint32_t seq);
  /// Members of the session have changed; `seq` if an input of this viewer did it.
  void state_changed(unsigned members, std::optional<std::uint32_t> seq);
  void report(const protocol::Problem& problem);
  /// Says bye and closes.
  void end(protocol::CloseCode code, const std::string& reason, bool reconnect);

  /// As what the next picture is to be made for it.
  PictureNeed need() const;
  /// From here on it is sent JPEG alone, and told why.
  void demote(const protocol::Problem& problem);
  /// What its link takes, as its acknowledgements tell.
  LinkPace pace() const;
  bool drives() const;
  /// Whether it watches, and one more picture may be on its way, or wait to be, than are and those in the making.
  bool takes_another(int in_the_making) const;
  bool watching() const;
  bool may_drive() const { return may_drive_; }
  const std::string& resume_token() const { return resume_token_; }

  /// Ends the stream of a client that neither acknowledges nor reads, or never said hello.
  void check_patience(SteadyTime now);

 private:
  struct Sent {
    std::uint32_t frame;
    SteadyTime at;
    double bytes = 0.0;
  };
  struct AppliedInput {
    std::uint64_t revision;
    std::uint32_t seq;
  };

  void received(const protocol::Hello& hello);
  void received(const protocol::Input& input);
  void received(const protocol::Look& look);
  template <class Message>
  void take_numbered(const Message& message,
                     std::optional<protocol::Problem> (ViewerHost::*apply)(const Message&, Viewer&));
  void received(const protocol::Ack& ack);
  void received(const protocol::Demotion& demotion);
  void received(const protocol::Ping& ping);
  void refuse_text(std::string_view text, const protocol::Problem& problem);
  void bad_message(const std::string& reason);

  // With the lock held.
  bool has_room() const;
  bool may_send_picture() const;
  void queue_text(const protocol::ServerMessage& message);
  void queue_end(protocol::CloseCode code, const std::string& reason, bool reconnect);
  std::string take_state_update();
  std::string take_placement();
  net::Outgoing take_picture();
  bool follows_on(const VideoPacket& packet) const;
  void note_arrival(const Sent& sent, const protocol::Ack& ack, SteadyTime now);
  void note_shown_inputs(std::uint64_t revision);
  void queue_stats(const Picture& picture, SteadyTime now);
  void wake();

  const std::shared_ptr<ViewerHost> host_;
  const bool may_drive_;
  const std::string resume_token_;
  const SteadyTime created_;

  mutable std::mutex mutex_;
  std::shared_ptr<net::WebSocketLink> link_;
  enum class Stage { kAwaitingHello, kWatching, kEnding, kClosed } stage_ = Stage::kAwaitingHello;
  bool drives_ = false;
  bool has_video_ = false;         // agreed to
  std::uint64_t video_index_ = 0;  // of the packet sent last; 0: a key is needed
  std::uint64_t source_ = 0;
  bool own_camera_ = false;
  std::deque<std::string> texts_;             // small and few: welcome, pongs, errors, bye
  std::optional<net::CloseMessage> closing_;  // after the texts
  SteadyTime ending_since_{};
  unsigned changed_members_ = 0;
  std::optional<std::uint32_t> changed_by_seq_;
  std::shared_ptr<const Picture> waiting_;      // the newest picture, not sent yet
  std::shared_ptr<const Placement> placement_;  // sent last
  std::deque<Sent> in_flight_;
  SteadyTime last_arrival_{};
  LinkPace pace_;
  std::uint32_t last_frame_ = 0;
  std::uint32_t last_seq_ = 0;        // received
  std::deque<AppliedInput> applied_;  // inputs no picture has shown yet
  std::uint32_t shown_seq_ = 0;
  std::deque<SteadyTime> sent_times_;  // of the last second
  SteadyTime stats_sent_{};
};

}  // namespace lightwell
