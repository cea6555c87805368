#include "server/net/connection.h"

#include <algorithm>
#include <optional>
#include <utility>

// <utility> before Asio: its 1.74 forgets it.
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/post.hpp>

#include "server/net/body_decoder.h"
#include "server/net/exchange.h"
#include "server/net/transport.h"
#include "server/net/web_socket.h"

namespace lightwell::net {
namespace {

using std::chrono::steady_clock;

constexpr std::size_t kReadBytes = 16 * 1024;
constexpr std::size_t kLargeReadBytes = 256 * 1024;      // while a large body arrives
constexpr auto kBodyPulse = std::chrono::seconds(5);     // between questions to a body that has nothing yet
constexpr auto kWatch = std::chrono::milliseconds(500);  // between looks at a client whose answer is being made
constexpr auto kLateHead = std::chrono::seconds(1);      // for the request of one who connects while the server drains

/// What the connection does after a request.
enum class After { kNextRequest, kClose, kGone };

Refusal busy(std::string detail) {
  return {503, std::move(detail), {{"Retry-After", "1"}}};
}

Refusal too_slow(const char* part, std::chrono::milliseconds limit) {
  const auto seconds = std::chrono::ceil<std::chrono::seconds>(limit).count();
  return {
      408, std::string("the request's ") + part + " did not arrive in time (" + std::to_string(seconds) + " s)", {}};
}

template <class Stream>
class Connection : public std::enable_shared_from_this<Connection<Stream>> {
 public:
  Connection(Stream stream, Peer peer, std::shared_ptr<Shared> shared)
      : shared_(std::move(shared)),
        transport_(std::make_shared<Transport<Stream>>(std::move(stream), shared_->options)),
        peer_(std::move(peer)),
        draining_(shared_->connections.draining()),
        came_late_(draining_) {}

  ~Connection() { shared_->connections.remove(this); }

  void start() {
    const auto weak = this->weak_from_this();
    const auto drain = [weak] {
      if (auto self = weak.lock()) asio::post(self->executor(), [self] { self->drain(); });
    };
    const auto let_go = [weak] {
      if (auto self = weak.lock()) self->let_go();
    };
    shared_->connections.add(this, {drain, let_go});
    asio::co_spawn(executor(), run(this->shared_from_this()), asio::detached);
  }

  void start_refusing() { asio::co_spawn(executor(), refuse_at_once(this->shared_from_this()), asio::detached); }

 private:
  const Strand& executor() const { return transport_->strand(); }

  Awaitable<void> run(std::shared_ptr<Connection> self) {
    After after = co_await shake_hands();
    while (after == After::kNextRequest) after = co_await serve_one();
    if (after == After::kClose) co_await transport_->linger();
    self.reset();
  }

  Awaitable<After> shake_hands() {
    const Handshake handshake = co_await transport_->shake_hands();
    if (handshake == Handshake::kDone) co_return After::kNextRequest;
    if (handshake == Handshake::kFailed) co_return After::kGone;
    // Whoever took the port for one without TLS is told so in words it understands.
    const Refusal refusal{400, "this port speaks TLS: use https", {}};
    co_await transport_->write_plain(shared_->application->refusal_response(refusal, false, nullptr));
    co_return After::kClose;
  }

  Awaitable<void> refuse_at_once(std::shared_ptr<Connection> self) {
    std::string response =
        shared_->application->refusal_response(busy("too many connections are open"), false, nullptr);
    co_await transport_->write(std::move(response));
    co_await transport_->linger();
    self.reset();
  }

  void drain() {
    draining_ = true;
    if (idle_) transport_->close();
    if (sends_rest_) exchange_->signal();  // a body that never ends asks whether it should
  }

  void let_go() {
    if (web_socket_) web_socket_->let_go();
    if (exchange_) exchange_->drop();
  }

  /// One request and its answer.
  Awaitable<After> serve_one() {
    std::size_t head_bytes = 0;
    Refusal refusal;
    const bool complete = co_await read_head(head_bytes, refusal);
    if (!complete && refusal.detail.empty()) co_return After::kGone;
    if (!complete) co_return co_await refuse(refusal);

    auto parsed = parse_request_head(std::string_view(buffer_).substr(0, head_bytes), shared_->options.head);
    buffer_.erase(0, head_bytes);
    if (auto* bad = std::get_if<Refusal>(&parsed)) co_return co_await refuse(*bad);
    RequestHead& head = std::get<RequestHead>(parsed);

    Admission admission = shared_->application->admit(head, peer_);
    if (auto* bad = std::get_if<Refusal>(&admission)) co_return co_await refuse(*bad, &head);
    if (auto* web_socket = std::get_if<WebSocketAdmission>(&admission)) {
      web_socket_ = make_web_socket(transport_->take_stream(), std::move(*web_socket), shared_);
      co_await web_socket_->run(head, !buffer_.empty());
      co_return After::kGone;
    }
    co_return co_await serve_http(std::move(head), std::get<HttpAdmission>(admission));
  }

  Awaitable<bool> read_head(std::size_t& head_bytes, Refusal& refusal) {
    auto deadline =
        steady_clock::now() + (buffer_.empty() ? shared_->options.idle_timeout : shared_->options.head_timeout);
    if (came_late_) deadline = steady_clock::now() + kLateHead;
    for (std::size_t scanned = 0;;) {
      const HeadScan scan = find_head_end(buffer_, scanned);
      head_bytes = scan.head_bytes;
      if (scan.state == HeadScan::State::kComplete) co_return true;
      if (scan.state == HeadScan::State::kBroken) {
        refusal.detail = "the request's head holds a control character or a line that does not end in CR LF";
        co_return false;
      }
      if (buffer_.size() > shared_->options.head.max_bytes) {
        refusal = head_too_large(shared_->options.head);
        co_return false;
      }
      scanned = buffer_.size();
      idle_ = buffer_.empty();
      if (idle_ && draining_ && !came_late_) co_return false;
      const bool first = buffer_.empty();
      const bool arrived = co_await transport_->read_some(buffer_, kReadBytes, deadline);
      idle_ = false;
      if (!arrived && transport_->timed_out() && !first) refusal = too_slow("head", shared_->options.head_timeout);
      if (!arrived) co_return false;
      if (first) deadline = steady_clock::now() + shared_->options.head_timeout;
    }
  }

  Awaitable<After> serve_http(RequestHead head, HttpAdmission admission) {
    BudgetShare share(shared_->bodies);
    BodyDecoder decoder(head, admission.max_body_bytes);
    if (head.expects_continue && !decoder.done() && !decoder.failure() && buffer_.empty()) {
      if (!co_await transport_->write("HTTP/1.1 100 Continue\r\n\r\n")) co_return After::kGone;
    }
    const auto start = steady_clock::now();
    while (!decoder.done()) {
      if (!decoder.failure() && !share.grow_to(decoder.size() + buffer_.size()))
        co_return co_await refuse(busy("too many request bodies are being received"));
      buffer_.erase(0, decoder.feed(buffer_));
      if (decoder.failure()) co_return co_await refuse(*decoder.failure());
      if (decoder.done()) break;
      const std::size_t room = decoder.size() > kLargeReadBytes ? kLargeReadBytes : kReadBytes;
      const auto deadline = transfer_deadline(shared_->options, start, decoder.size());
      if (co_await transport_->read_some(buffer_, room, deadline)) continue;
      if (!transport_->timed_out()) co_return After::kGone;
      co_return co_await refuse(too_slow("body", shared_->options.stall_timeout));
    }
    const bool keep_alive = head.keep_alive && !draining_;
    Request request{std::move(head), decoder.take_body(), peer_, keep_alive, nullptr};
    if (!co_await answer(std::move(request))) co_return After::kGone;
    co_return keep_alive ? After::kNextRequest : After::kClose;
  }

  Awaitable<bool> answer(Request request) {
    const auto gone = std::make_shared<std::atomic<bool>>(false);
    const bool may_probe = request.head.minor_version > 0;
    request.gone = gone;
    const auto exchange = exchange_ = std::make_shared<Exchange>(executor());
    shared_->application->answer(std::move(request), [self = this->shared_from_this(), exchange](Answer answer) {
      exchange->leave(std::move(answer));
      asio::post(self->executor(), [exchange] { exchange->signal(); });
    });
    while (!exchange->answered()) {
      co_await exchange->wait(kWatch);
      if (!exchange->answered() && !*gone) *gone = !co_await still_there(may_probe);
    }
    const bool sent = co_await transport_->write(std::move(exchange->answer().bytes)) && co_await send_rest(exchange);
    exchange_.reset();
    co_return sent;
  }

  Awaitable<bool> send_rest(std::shared_ptr<Exchange> exchange) {
    if (!exchange->answer().rest) co_return true;
    sends_rest_ = true;
    const bool sent = co_await write_rest(*exchange->answer().rest, exchange);
    sends_rest_ = false;
    co_return sent;
  }

  /// Whether the client may still want its answer. One that has closed its side may wait for it, or have left for good:
  /// bytes for one that has left come back as a reset, and an interim response is what a client may be sent at any time
  /// and passes over (RFC 9110, 15.2). Not by HTTP/1.0.
  Awaitable<bool> still_there(bool may_probe) {
    const PeerState peer = transport_->peer();
    if (peer != PeerState::kHalfClosed || !may_probe) co_return peer != PeerState::kGone;
    co_return co_await transport_->write("HTTP/1.1 100 Continue\r\n\r\n");
  }

  Awaitable<bool> write_rest(BodySource& rest, std::shared_ptr<Exchange> exchange) {
    // Weakly, or the body would keep alive what keeps it.
    rest.set_waker([executor = executor(), weak = std::weak_ptr<Exchange>(exchange)] {
      if (auto woken = weak.lock()) asio::post(executor, [woken] { woken->signal(); });
    });
    while (transport_->peer() != PeerState::kGone) {
      exchange->await_anew();
      std::optional<std::string> piece = rest.next();
      if (!piece) co_return rest.is_whole();
      if (piece->empty())
        co_await exchange->wait(kBodyPulse);
      else if (!co_await transport_->write(std::move(*piece)))
        co_return false;
    }
    co_return false;
  }

  /// Answers with a problem. The connection can go on only if the request has no body that is still to come.
  Awaitable<After> refuse(Refusal refusal, const RequestHead* head = nullptr) {
    const bool keep_alive = head && head->keep_alive && head->framing == Framing::kNone && !draining_;
    std::string response = shared_->application->refusal_response(refusal, keep_alive, head);
    if (head && head->method == "HEAD") response.erase(std::min(response.find("\r\n\r\n") + 4, response.size()));
    if (!co_await transport_->write(std::move(response))) co_return After::kGone;
    co_return keep_alive ? After::kNextRequest : After::kClose;
  }

  std::shared_ptr<Shared> shared_;
  const std::shared_ptr<Transport<Stream>> transport_;
  Peer peer_;
  std::string buffer_;  // what has arrived and is not consumed
  bool idle_ = false;   // waits for the first byte of a request
  bool draining_ = false;
  const bool came_late_;                // when the server drained already: one request, if it comes soon
  std::shared_ptr<Exchange> exchange_;  // while a request is answered
  bool sends_rest_ = false;             // its body is sent as it is made
  std::shared_ptr<WebSocketEnd> web_socket_;
};

}  // namespace

void serve_connection(TcpStream stream, Peer peer, std::shared_ptr<Shared> shared) {
  if (shared->tls) {
    TlsStream tls(std::move(stream), *shared->tls);
    return std::make_shared<Connection<TlsStream>>(std::move(tls), std::move(peer), std::move(shared))->start();
  }
  std::make_shared<Connection<TcpStream>>(std::move(stream), std::move(peer), std::move(shared))->start();
}

void refuse_connection(TcpStream stream, std::shared_ptr<Shared> shared) {
  std::make_shared<Connection<TcpStream>>(std::move(stream), Peer{}, std::move(shared))->start_refusing();
}

}  // namespace lightwell::net
