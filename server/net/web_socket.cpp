#include "server/net/web_socket.h"

#include <algorithm>
#include <array>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <boost/beast/websocket/stream.hpp>

namespace lightwell::net {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::system::error_code;

constexpr std::size_t kReadBytes = 64 << 10;  // taken at once of a message

constexpr auto kHandshakeTimeout = std::chrono::seconds(10);  // of the opening and of the closing one

/// What was understood, written anew. The subprotocol is chosen already.
http::request<http::empty_body> handshake_request(const RequestHead& head) {
  http::request<http::empty_body> request(http::verb::get, "/", 11);
  const auto key = head.field("sec-websocket-key");
  request.set(http::field::host, "here");
  request.set(http::field::upgrade, "websocket");
  request.set(http::field::connection, "upgrade");
  request.set(http::field::sec_websocket_key, boost::string_view(key.data(), key.size()));
  request.set(http::field::sec_websocket_version, "13");
  return request;
}

/// Whether a text that is good UTF-8 otherwise ends within a character. Beast looks at the last bytes of a message only
/// if its last frame has any.
bool ends_within_character(std::string_view text) {
  for (std::size_t back = 1; back <= std::min<std::size_t>(text.size(), 3); ++back) {
    const auto byte = static_cast<unsigned char>(text[text.size() - back]);
    if ((byte & 0xc0) == 0x80) continue;
    const std::size_t length = byte >= 0xf0 ? 4 : byte >= 0xe0 ? 3 : byte >= 0xc0 ? 2 : 1;
    return length > back;
  }
  return false;
}

template <class Stream>
class WebSocketConnection : public WebSocketEnd,
                            public WebSocketLink,
                            public std::enable_shared_from_this<WebSocketConnection<Stream>> {
 public:
  WebSocketConnection(Stream stream, WebSocketAdmission admission, std::shared_ptr<Shared> shared)
      : shared_(std::move(shared)),
        strand_(stream.get_executor()),
        stream_(std::move(stream)),
        admission_(std::move(admission)),
        woken_(strand_, std::chrono::steady_clock::time_point::max()) {}

  void wake() override {
    asio::post(strand_, [self = this->shared_from_this()] {
      self->may_send_ = true;
      self->woken_.cancel();
    });
  }

  void abort() override {
    asio::post(strand_, [self = this->shared_from_this()] { beast::get_lowest_layer(self->stream_).close(); });
  }

  asio::awaitable<void> run(const RequestHead& head, bool early_bytes) override {
    const bool open = !early_bytes && co_await accept(head);
    try {
      if (open) co_await converse();
    } catch (const std::exception&) {  // out of memory, say: the end of this conversation alone
      beast::get_lowest_layer(stream_).close();
    }
    woken_.cancel();
    let_go();
  }

  /// The handler has the link, by which the two would keep each other.
  void let_go() override {
    if (closed_) return;
    closed_ = true;
    admission_.handler->closed();
    admission_.handler.reset();
  }

 private:
  asio::awaitable<bool> accept(const RequestHead& head) {
    beast::get_lowest_layer(stream_).expires_never();  // the WebSocket has its own time-outs
    websocket::stream_base::timeout timeouts{};
    timeouts.handshake_timeout = kHandshakeTimeout;
    timeouts.idle_timeout = shared_->options.web_socket_idle_timeout;
    timeouts.keep_alive_pings = true;
    stream_.set_option(timeouts);
    stream_.set_option(websocket::stream_base::decorator([this](websocket::response_type& response) {
      if (!admission_.subprotocol.empty()) response.set(http::field::sec_websocket_protocol, admission_.subprotocol);
    }));
    stream_.read_message_max(0);   // read_messages keeps the limit
    stream_.auto_fragment(false);  // a picture is one frame: nobody speaks in between
    const auto request = handshake_request(head);
    error_code error;
    co_await stream_.async_accept(request, asio::redirect_error(asio::use_awaitable, error));
    co_return !error;
  }

  asio::awaitable<void> converse() {
    admission_.handler->opened(this->shared_from_this());
    may_send_ = true;
    asio::co_spawn(strand_, write_messages(this->shared_from_this()), asio::detached);
    co_await read_messages();
  }

  asio::awaitable<void> read_messages() {
    beast::flat_buffer buffer;
    for (;;) {
      error_code error;
      // Not async_read with a limit: that would reset the connection while the rest of the message arrives, and the
      // reason with it. Closing here reads on until the peer has answered.
      do {
        co_await stream_.async_read_some(buffer, kReadBytes, asio::redirect_error(asio::use_awaitable, error));
        if (error) co_return;  // closed, broken or silent: Beast has told the peer which
        if (buffer.size() > admission_.max_message_bytes) co_return co_await fail(websocket::close_code::too_big);
      } while (!stream_.is_message_done());
      const auto data = buffer.data();
      const std::string_view bytes(static_cast<const char*>(data.data()), data.size());
      if (stream_.got_text() && ends_within_character(bytes))
        co_return co_await fail(websocket::close_code::bad_payload);
      if (stream_.got_text())
        admission_.handler->received_text(bytes);
      else
        admission_.handler->received_binary(bytes);
      buffer.clear();
    }
  }

  asio::awaitable<void> fail(websocket::close_code code) {
    error_code ignored;
    co_await stream_.async_close(code, asio::redirect_error(asio::use_awaitable, ignored));
  }

  asio::awaitable<void> write_messages(std::shared_ptr<WebSocketConnection> self) {
    while (!closed_) {
      const Outgoing message = may_send_ ? admission_.handler->next() : Outgoing();
      error_code error;
      if (const auto* close = std::get_if<CloseMessage>(&message)) {
        const websocket::close_reason reason(static_cast<websocket::close_code>(close->code), close->reason);
        co_await stream_.async_close(reason, asio::redirect_error(asio::use_awaitable, error));
        beast::get_lowest_layer(stream_).close();
        break;
      }
      if (std::holds_alternative<std::monostate>(message)) {
        may_send_ = false;
        co_await woken_.async_wait(asio::redirect_error(asio::use_awaitable, error));
        continue;
      }
      if (!co_await send(message)) break;
    }
    self.reset();
  }

  asio::awaitable<bool> send(const Outgoing& message) {
    error_code error;
    if (const auto* text = std::get_if<TextMessage>(&message)) {
      stream_.text(true);
      co_await stream_.async_write(asio::buffer(text->text), asio::redirect_error(asio::use_awaitable, error));
    } else {
      const auto& binary = std::get<BinaryMessage>(message);
      stream_.binary(true);
      const std::array<asio::const_buffer, 2> parts{asio::buffer(binary.head), asio::buffer(*binary.payload)};
      co_await stream_.async_write(parts, asio::redirect_error(asio::use_awaitable, error));
    }
    co_return !error;
  }

  std::shared_ptr<Shared> shared_;
  Strand strand_;
  websocket::stream<Stream> stream_;
  WebSocketAdmission admission_;
  asio::steady_timer woken_;  // never fires: cancelled by `wake`
  bool may_send_ = false;
  bool closed_ = false;
};

}  // namespace

std::shared_ptr<WebSocketEnd> make_web_socket(TcpStream stream, WebSocketAdmission admission,
                                              std::shared_ptr<Shared> shared) {
  return std::make_shared<WebSocketConnection<TcpStream>>(std::move(stream), std::move(admission), std::move(shared));
}

std::shared_ptr<WebSocketEnd> make_web_socket(TlsStream stream, WebSocketAdmission admission,
                                              std::shared_ptr<Shared> shared) {
  return std::make_shared<WebSocketConnection<TlsStream>>(std::move(stream), std::move(admission), std::move(shared));
}

}  // namespace lightwell::net
