// What the connection layer asks of the program it serves. It knows HTTP and WebSocket, and nothing of scenes.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "server/net/request_head.h"

namespace lightwell::net {

struct Peer {
  std::string address;
  int port = 0;
};

/// A request whose body has arrived in full.
struct Request {
  RequestHead head;
  std::string body;
  Peer peer;
  bool keep_alive = true;                   // false: the answer must say "Connection: close"
  std::shared_ptr<std::atomic<bool>> gone;  // set once the client has left: its answer is in vain
};

/// The rest of an answer, made while it is sent: a file that is large, events as they happen. Asked on an I/O thread,
/// and gone once the server has stopped.
class BodySource {
 public:
  virtual ~BodySource() = default;
  /// The bytes that come next, as they go over the wire; empty: nothing yet; none: the end. Asked again when it has
  /// been woken, and every few seconds. Must not block for long.
  virtual std::optional<std::string> next() = 0;
  /// After the end: whether all of it came. If not, the connection is closed, by which the client knows.
  virtual bool is_whole() const { return true; }
  /// Called once, before the first `next`. `wake` may be called from any thread at any time, whether or not anyone
  /// still listens.
  virtual void set_waker(std::function<void()> wake) = 0;
};

/// A response in bytes, and what follows them, if anything.
struct Answer {
  std::string bytes;
  std::shared_ptr<BodySource> rest;
};

/// One WebSocket message to send, or the end of the conversation.
struct TextMessage {
  std::string text;
};
struct BinaryMessage {
  std::string head;                                          // sent first, the message's own
  std::shared_ptr<const std::vector<std::uint8_t>> payload;  // shared among receivers
};
struct CloseMessage {
  std::uint16_t code = 1000;
  std::string reason;  // at most 123 bytes
};
using Outgoing = std::variant<std::monostate, TextMessage, BinaryMessage, CloseMessage>;

/// A WebSocket as its handler sees it. Every call may come from any thread, and does nothing once it is closed.
class WebSocketLink {
 public:
  virtual ~WebSocketLink() = default;
  /// There may be something to send: `next` is asked soon.
  virtual void wake() = 0;
  /// Ends the connection at once, without a closing handshake: for a peer that does not read.
  virtual void abort() = 0;
};

/// One end of a conversation. All calls come one after another, never two at a time; none may block.
class WebSocketHandler {
 public:
  virtual ~WebSocketHandler() = default;
  /// The handshake is done. The link is given up by `closed`.
  virtual void opened(std::shared_ptr<WebSocketLink> link) = 0;
  virtual void received_text(std::string_view text) = 0;
  virtual void received_binary(std::string_view bytes) = 0;
  /// What to send next; monostate: nothing until the link is woken. Asked again when it has been sent, so that what
  /// has become stale in the meantime need not be sent. After a CloseMessage it is not asked again.
  virtual Outgoing next() = 0;
  /// The last call; also made when the handshake failed and `opened` never came. Where the server is stopped it comes
  /// from the thread that stops it.
  virtual void closed() = 0;
};

/// How a WebSocket handshake is answered.
struct WebSocketAdmission {
  std::shared_ptr<WebSocketHandler> handler;
  std::string subprotocol;  // told to the client; empty: none
  std::uint64_t max_message_bytes = 1u << 20;
};

/// A request that is served once its body is there.
struct HttpAdmission {
  std::uint64_t max_body_bytes = 0;
};

using Admission = std::variant<Refusal, HttpAdmission, WebSocketAdmission>;

class Application {
 public:
  virtual ~Application() = default;
  /// Decides on a request by its head, before any of its body is read. On an I/O thread: must not block.
  virtual Admission admit(const RequestHead& head, const Peer& peer) = 0;
  /// Answers an admitted request: `done` gets the response exactly once, from any thread. Called on an I/O thread: must
  /// not block.
  virtual void answer(Request request, std::function<void(Answer)> done) = 0;
  /// A refusal as a whole response in bytes. `head`: of the request refused; null if it was not understood.
  virtual std::string refusal_response(const Refusal& refusal, bool keep_alive, const RequestHead* head) = 0;
};

}  // namespace lightwell::net
