// Bytes to and from one peer, over TCP or TLS, with a time limit on everything. Private to the connection layer.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

// <utility> before Asio: its 1.74 forgets it.
#include <boost/asio/awaitable.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/ssl/error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>

#include "server/net/shared.h"

namespace lightwell::net {

namespace asio = boost::asio;
using boost::system::error_code;
using SteadyTime = std::chrono::steady_clock::time_point;
template <class T>
using Awaitable = asio::awaitable<T>;

/// What a peer's side of a connection is like, seen without reading from it.
enum class PeerState {
  kOpen,
  kHalfClosed,  // it sends no more; whether it still reads is not to be seen
  kGone,        // it has reset the connection
};
PeerState peer_state(int socket);

/// When a transfer that began at `start` and has moved `bytes` must have moved on: the stall timeout from now, but no
/// later than its least speed allows.
SteadyTime transfer_deadline(const ServerOptions& options, SteadyTime start, std::uint64_t bytes);

enum class Handshake { kDone, kPlainHttp, kFailed };

/// All calls come on the stream's strand, one awaited after another. Held by a shared pointer.
template <class Stream>
class Transport : public std::enable_shared_from_this<Transport<Stream>> {
 public:
  /// `options` outlives it.
  Transport(Stream stream, const ServerOptions& options)
      : options_(options), strand_(stream.get_executor()), stream_(std::move(stream)), patience_(strand_) {}

  const Strand& strand() const { return strand_; }
  PeerState peer() { return peer_state(socket().native_handle()); }
  void close() { lowest().close(); }
  /// For who goes on with it in another protocol; nothing else is asked of the transport afterwards.
  Stream take_stream() { return std::move(stream_); }

  /// TLS's, where it is spoken.
  Awaitable<Handshake> shake_hands() {
    if constexpr (std::is_same_v<Stream, TlsStream>) {
      error_code error;
      lowest().expires_after(options_.head_timeout);
      co_await stream_.async_handshake(asio::ssl::stream_base::server,
                                       asio::redirect_error(asio::use_awaitable, error));
      lowest().expires_never();
      const auto reason = ERR_GET_REASON(static_cast<unsigned long>(error.value()));
      if (error) co_return reason == SSL_R_HTTP_REQUEST ? Handshake::kPlainHttp : Handshake::kFailed;
    }
    co_return Handshake::kDone;
  }

  /// Appends what arrives next to `buffer`, at most `room` bytes. False: the peer has closed its side, the connection
  /// broke, or `timed_out`: then an answer can still be sent.
  Awaitable<bool> read_some(std::string& buffer, std::size_t room, SteadyTime deadline) {
    const std::size_t old_size = buffer.size();
    buffer.resize(old_size + room);
    timed_out_ = false;
    patience_.expires_at(deadline);
    reading_ = true;
    patience_.async_wait([self = this->shared_from_this(), deadline](error_code error) {
      error_code ignored;
      if (error || !self->reading_ || self->patience_.expiry() != deadline) return;
      self->timed_out_ = true;
      self->socket().cancel(ignored);
    });
    error_code error;
    const std::size_t count = co_await stream_.async_read_some(asio::buffer(buffer.data() + old_size, room),
                                                               asio::redirect_error(asio::use_awaitable, error));
    reading_ = false;
    patience_.cancel();
    buffer.resize(old_size + count);
    co_return !error && count > 0;
  }
  bool timed_out() const { return timed_out_; }

  Awaitable<bool> write(std::string bytes) {
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t sent = 0; sent < bytes.size();) {
      lowest().expires_at(transfer_deadline(options_, start, sent));
      error_code error;
      sent += co_await stream_.async_write_some(asio::buffer(bytes.data() + sent, bytes.size() - sent),
                                                asio::redirect_error(asio::use_awaitable, error));
      if (error) co_return false;
    }
    lowest().expires_never();
    co_return true;
  }

  /// Past TLS, to who does not speak it.
  Awaitable<void> write_plain(std::string bytes) {
    error_code ignored;
    lowest().expires_after(kLinger);
    co_await asio::async_write(lowest(), asio::buffer(bytes), asio::redirect_error(asio::use_awaitable, ignored));
  }

  /// Closes our side and reads on for a moment: closing with unread bytes would reset the connection, and the peer
  /// might never see the answer.
  Awaitable<void> linger() {
    error_code ignored;
    if constexpr (std::is_same_v<Stream, TlsStream>) {
      lowest().expires_after(kLinger);
      co_await stream_.async_shutdown(asio::redirect_error(asio::use_awaitable, ignored));
    }
    socket().shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
    const auto deadline = std::chrono::steady_clock::now() + kLinger;
    std::string rest(16 * 1024, '\0');
    std::size_t count = 0;
    for (std::size_t read = 0; read < kMaxLingerBytes; read += count) {
      lowest().expires_at(deadline);
      count = co_await lowest().async_read_some(asio::buffer(rest), asio::redirect_error(asio::use_awaitable, ignored));
      if (ignored || count == 0) break;
    }
  }

 private:
  static constexpr std::size_t kMaxLingerBytes = 1 << 20;
  static constexpr auto kLinger = std::chrono::seconds(2);

  auto& lowest() { return boost::beast::get_lowest_layer(stream_); }
  auto& socket() { return lowest().socket(); }

  const ServerOptions& options_;
  Strand strand_;
  Stream stream_;
  asio::steady_timer patience_;  // with a peer that sends nothing
  bool reading_ = false;
  bool timed_out_ = false;  // it ended the last read
};

}  // namespace lightwell::net
