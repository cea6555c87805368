#include "server/net/connection.h"

#include <sys/socket.h>

#include <algorithm>
#include <optional>
#include <type_traits>
#include <utility>

// <utility> before Asio: its 1.74 forgets it.
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/ssl/error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>

#include "server/net/body_decoder.h"
#include "server/net/web_socket.h"

namespace lightwell::net {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;
using std::chrono::steady_clock;

constexpr std::size_t kReadBytes = 16 * 1024;
constexpr std::size_t kLargeReadBytes = 256 * 1024;  // while a large body arrives
constexpr std::size_t kMaxLingerBytes = 1 << 20;
constexpr auto kLinger = std::chrono::seconds(2);
constexpr auto kBodyPulse = std::chrono::seconds(5);  // between questions to a body that has nothing yet
constexpr auto kLateHead = std::chrono::seconds(1);   // for the request of one who connects while the server drains

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

/// Gives bytes of a budget back when it goes.
class BudgetShare {
 public:
  explicit BudgetShare(ByteBudget& budget) : budget_(budget) {}
  ~BudgetShare() { budget_.give_back(taken_); }
  BudgetShare(const BudgetShare&) = delete;
  BudgetShare& operator=(const BudgetShare&) = delete;

  /// Takes what is missing to `bytes` in all.
  bool grow_to(std::uint64_t bytes) {
    if (bytes <= taken_) return true;
    if (!budget_.take(bytes - taken_)) return false;
    taken_ = bytes;
    return true;
  }

 private:
  ByteBudget& budget_;
  std::uint64_t taken_ = 0;
};

template <class Stream>
class Connection : public std::enable_shared_from_this<Connection<Stream>> {
 public:
  Connection(Stream stream, Peer peer, std::shared_ptr<Shared> shared)
      : shared_(std::move(shared)),
        strand_(stream.get_executor()),
        stream_(std::move(stream)),
        peer_(std::move(peer)),
        patience_(strand_),
        draining_(shared_->connections.draining()),
        came_late_(draining_) {}

  ~Connection() { shared_->connections.remove(this); }

  void start() {
    shared_->connections.add(this, [weak = this->weak_from_this()] {
      if (auto self = weak.lock()) asio::post(self->executor(), [self] { self->drain(); });
    });
    asio::co_spawn(executor(), run(this->shared_from_this()), asio::detached);
  }

  void start_refusing() { asio::co_spawn(executor(), refuse_at_once(this->shared_from_this()), asio::detached); }

 private:
  /// Where the answer of a worker is left for the strand. Outlives both.
  struct Exchange {
    explicit Exchange(const Strand& strand) : answered(strand, steady_clock::time_point::max()) {}
    void signal() {
      woken = true;
      answered.cancel();
    }

    asio::steady_timer answered;  // never fires while the answer is waited for: cancelled by `signal`
    bool woken = false;
    std::optional<Answer> answer;
  };

  const Strand& executor() const { return strand_; }
  auto& socket() { return boost::beast::get_lowest_layer(stream_).socket(); }
  auto& lowest() { return boost::beast::get_lowest_layer(stream_); }

  asio::awaitable<void> run(std::shared_ptr<Connection> self) {
    After after = co_await shake_hands() ? After::kNextRequest : After::kGone;
    while (after == After::kNextRequest) after = co_await serve_one();
    if (after == After::kClose) co_await linger();
    self.reset();
  }

  /// False if the other side does not speak TLS where it must.
  asio::awaitable<bool> shake_hands() {
    if constexpr (std::is_same_v<Stream, TlsStream>) {
      error_code error;
      lowest().expires_after(shared_->options.head_timeout);
      co_await stream_.async_handshake(asio::ssl::stream_base::server,
                                       asio::redirect_error(asio::use_awaitable, error));
      lowest().expires_never();
      if (!error) co_return true;
      if (ERR_GET_REASON(static_cast<unsigned long>(error.value())) == SSL_R_HTTP_REQUEST) co_await refuse_plain_http();
      co_return false;
    }
    co_return true;
  }

  /// Whoever took the port for one without TLS is told so in words it understands.
  asio::awaitable<void> refuse_plain_http() {
    const Refusal refusal{400, "this port speaks TLS: use https", {}};
    const std::string response = shared_->application->refusal_response(refusal, false, nullptr);
    error_code ignored;
    lowest().expires_after(kLinger);
    co_await asio::async_write(lowest(), asio::buffer(response), asio::redirect_error(asio::use_awaitable, ignored));
    co_await linger();
  }

  asio::awaitable<void> refuse_at_once(std::shared_ptr<Connection> self) {
    std::string response =
        shared_->application->refusal_response(busy("too many connections are open"), false, nullptr);
    co_await write(std::move(response));
    co_await linger();
    self.reset();
  }

  void drain() {
    draining_ = true;
    if (idle_) lowest().close();
    if (exchange_) exchange_->signal();  // a body that never ends asks whether it should
  }

  /// One request and its answer.
  asio::awaitable<After> serve_one() {
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
      co_await serve_web_socket(std::move(stream_), head, std::move(*web_socket), shared_, !buffer_.empty());
      co_return After::kGone;
    }
    co_return co_await serve_http(std::move(head), std::get<HttpAdmission>(admission));
  }

  asio::awaitable<bool> read_head(std::size_t& head_bytes, Refusal& refusal) {
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
      const bool arrived = co_await read_some(kReadBytes, deadline);
      idle_ = false;
      if (!arrived && timed_out_ && !first) refusal = too_slow("head", shared_->options.head_timeout);
      if (!arrived) co_return false;
      if (first) deadline = steady_clock::now() + shared_->options.head_timeout;
    }
  }

  asio::awaitable<After> serve_http(RequestHead head, HttpAdmission admission) {
    BudgetShare share(shared_->bodies);
    BodyDecoder decoder(head, admission.max_body_bytes);
    if (head.expects_continue && !decoder.done() && !decoder.failure() && buffer_.empty()) {
      if (!co_await write("HTTP/1.1 100 Continue\r\n\r\n")) co_return After::kGone;
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
      if (co_await read_some(room, deadline)) continue;
      if (!timed_out_) co_return After::kGone;
      co_return co_await refuse(too_slow("body", shared_->options.stall_timeout));
    }
    const bool keep_alive = head.keep_alive && !draining_;
    Request request{std::move(head), decoder.take_body(), peer_, keep_alive, nullptr};
    if (!co_await answer(std::move(request))) co_return After::kGone;
    co_return keep_alive ? After::kNextRequest : After::kClose;
  }

  asio::awaitable<bool> answer(Request request) {
    auto gone = std::make_shared<std::atomic<bool>>(false);
    request.gone = gone;
    auto exchange = std::make_shared<Exchange>(executor());
    shared_->application->answer(std::move(request), [self = this->shared_from_this(), exchange](Answer answer) {
      asio::post(self->executor(), [exchange, answer = std::move(answer)]() mutable {
        exchange->answer = std::move(answer);
        exchange->signal();
      });
    });
    watch_for_hang_up(gone, exchange);
    error_code ignored;
    while (!exchange->answer)
      co_await exchange->answered.async_wait(asio::redirect_error(asio::use_awaitable, ignored));
    socket().cancel(ignored);  // the watch
    if (!co_await write(std::move(exchange->answer->bytes))) co_return false;
    if (!exchange->answer->rest) co_return true;
    exchange_ = exchange;
    const bool sent = co_await write_rest(*exchange->answer->rest, gone, exchange);
    exchange_.reset();
    co_return sent;
  }

  asio::awaitable<bool> write_rest(BodySource& rest, std::shared_ptr<std::atomic<bool>> gone,
                                   std::shared_ptr<Exchange> exchange) {
    // Weakly, or the body would keep alive what keeps it.
    rest.set_waker([executor = executor(), weak = std::weak_ptr<Exchange>(exchange)] {
      if (auto woken = weak.lock()) asio::post(executor, [woken] { woken->signal(); });
    });
    watch_for_hang_up(gone, exchange);
    bool sent = true;
    while (sent && !*gone) {
      exchange->woken = false;
      std::optional<std::string> piece = rest.next();
      if (!piece) break;
      if (!piece->empty()) {
        sent = co_await write(std::move(*piece));
        continue;
      }
      error_code ignored;
      exchange->answered.expires_after(kBodyPulse);
      if (!exchange->woken) co_await exchange->answered.async_wait(asio::redirect_error(asio::use_awaitable, ignored));
    }
    error_code ignored;
    socket().cancel(ignored);  // the watch
    co_return sent && !*gone;
  }

  /// Tells the worker when the client has closed its side while it waits for the answer.
  void watch_for_hang_up(std::shared_ptr<std::atomic<bool>> gone, std::shared_ptr<Exchange> exchange) {
    const auto seen = [self = this->shared_from_this(), gone, exchange](error_code error) {
      if (error) return;
      char byte = 0;
      if (::recv(self->socket().native_handle(), &byte, 1, MSG_PEEK | MSG_DONTWAIT) != 0) return;
      *gone = true;
      exchange->signal();
    };
    socket().async_wait(asio::ip::tcp::socket::wait_read, seen);
  }

  /// Answers with a problem. The connection can go on only if the request has no body that is still to come.
  asio::awaitable<After> refuse(Refusal refusal, const RequestHead* head = nullptr) {
    const bool keep_alive = head && head->keep_alive && head->framing == Framing::kNone && !draining_;
    std::string response = shared_->application->refusal_response(refusal, keep_alive, head);
    if (head && head->method == "HEAD") response.erase(std::min(response.find("\r\n\r\n") + 4, response.size()));
    if (!co_await write(std::move(response))) co_return After::kGone;
    co_return keep_alive ? After::kNextRequest : After::kClose;
  }

  asio::awaitable<bool> read_some(std::size_t room, steady_clock::time_point deadline) {
    const std::size_t old_size = buffer_.size();
    buffer_.resize(old_size + room);
    timed_out_ = false;
    patience_.expires_at(deadline);
    reading_ = true;
    patience_.async_wait([self = this->shared_from_this(), deadline](error_code error) {
      error_code ignored;
      if (error || !self->reading_ || self->patience_.expiry() != deadline) return;
      self->timed_out_ = true;  // cancelled, not closed: the answer can still be sent
      self->socket().cancel(ignored);
    });
    error_code error;
    const std::size_t count = co_await stream_.async_read_some(asio::buffer(buffer_.data() + old_size, room),
                                                               asio::redirect_error(asio::use_awaitable, error));
    reading_ = false;
    patience_.cancel();
    buffer_.resize(old_size + count);
    co_return !error && count > 0;
  }

  asio::awaitable<bool> write(std::string bytes) {
    const auto start = steady_clock::now();
    for (std::size_t sent = 0; sent < bytes.size();) {
      lowest().expires_at(transfer_deadline(shared_->options, start, sent));
      error_code error;
      sent += co_await stream_.async_write_some(asio::buffer(bytes.data() + sent, bytes.size() - sent),
                                                asio::redirect_error(asio::use_awaitable, error));
      if (error) co_return false;
    }
    lowest().expires_never();
    co_return true;
  }

  /// Closes our side and reads on for a moment: closing with unread bytes would reset the connection, and the peer
  /// might never see the answer.
  asio::awaitable<void> linger() {
    error_code ignored;
    if constexpr (std::is_same_v<Stream, TlsStream>) {
      lowest().expires_after(kLinger);
      co_await stream_.async_shutdown(asio::redirect_error(asio::use_awaitable, ignored));
    }
    socket().shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
    const auto deadline = steady_clock::now() + kLinger;
    std::size_t count = 0;
    buffer_.resize(kReadBytes);
    for (std::size_t read = 0; read < kMaxLingerBytes; read += count) {
      lowest().expires_at(deadline);
      count =
          co_await lowest().async_read_some(asio::buffer(buffer_), asio::redirect_error(asio::use_awaitable, ignored));
      if (ignored || count == 0) break;
    }
  }

  std::shared_ptr<Shared> shared_;
  Strand strand_;
  Stream stream_;  // moved away once it has become a WebSocket
  Peer peer_;
  std::string buffer_;           // what has arrived and is not consumed
  asio::steady_timer patience_;  // with a peer that sends nothing
  bool reading_ = false;
  bool timed_out_ = false;  // it ended the last read
  bool idle_ = false;       // waits for the first byte of a request
  bool draining_ = false;
  const bool came_late_;                // when the server drained already: one request, if it comes soon
  std::shared_ptr<Exchange> exchange_;  // while a body is sent as it is made
};

}  // namespace

bool ByteBudget::take(std::uint64_t bytes) {
  const auto wanted = static_cast<std::int64_t>(bytes);
  if (left_.fetch_sub(wanted) >= wanted) return true;
  left_ += wanted;
  return false;
}

void ConnectionSet::add(const void* connection, std::function<void()> drain) {
  std::lock_guard lock(mutex_);
  if (!draining_) drains_[connection] = std::move(drain);
}

void ConnectionSet::remove(const void* connection) {
  std::lock_guard lock(mutex_);
  drains_.erase(connection);
  if (drains_.empty()) emptied_.notify_all();
}

int ConnectionSet::size() const {
  std::lock_guard lock(mutex_);
  return static_cast<int>(drains_.size());
}

void ConnectionSet::drain_all() {
  std::unordered_map<const void*, std::function<void()>> drains;
  {
    std::lock_guard lock(mutex_);
    draining_ = true;
    drains = drains_;
  }
  for (const auto& [connection, drain] : drains) drain();
}

bool ConnectionSet::draining() const {
  std::lock_guard lock(mutex_);
  return draining_;
}

bool ConnectionSet::wait_until_empty(std::chrono::milliseconds limit) {
  std::unique_lock lock(mutex_);
  return emptied_.wait_for(lock, limit, [this] { return drains_.empty(); });
}

steady_clock::time_point transfer_deadline(const ServerOptions& options, steady_clock::time_point start,
                                           std::uint64_t bytes) {
  const std::chrono::duration<double> allowed(static_cast<double>(bytes) / options.min_bytes_per_s);
  const auto slowest = start + options.stall_timeout + std::chrono::duration_cast<steady_clock::duration>(allowed);
  return std::min(steady_clock::now() + options.stall_timeout, slowest);
}

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
