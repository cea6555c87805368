#include "tests/integration/stream_client.h"

#include <utility>

// <utility> before Asio: its 1.74 forgets it.
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>

namespace lightwell::test {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

struct WebSocketClient::State {
  asio::io_context io;
  websocket::stream<tcp::socket> stream{io};
  beast::flat_buffer buffer;
  std::string subprotocol;
  bool reading = false;  // a read that did not end within its limit goes on in the next
  bool ended = false;
  error_code read_error;

  /// Runs what has been started until `done` or the limit.
  template <class Done>
  void run(std::chrono::milliseconds limit, const Done& done) {
    const auto deadline = std::chrono::steady_clock::now() + limit;
    io.restart();
    while (!done() && std::chrono::steady_clock::now() < deadline) io.run_one_until(deadline);
  }
};

WebSocketClient::WebSocketClient() : state_(std::make_unique<State>()) {}
WebSocketClient::~WebSocketClient() = default;
WebSocketClient::WebSocketClient(WebSocketClient&&) noexcept = default;

int WebSocketClient::open(int port, const std::string& target, const Options& options) {
  tcp::socket& socket = state_->stream.next_layer();
  socket.open(tcp::v4());
  if (options.receive_buffer_bytes > 0)
    socket.set_option(asio::socket_base::receive_buffer_size(options.receive_buffer_bytes));
  socket.connect({asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(port)});
  socket.set_option(tcp::no_delay(true));
  state_->stream.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
    if (!options.subprotocol.empty()) request.set(http::field::sec_websocket_protocol, options.subprotocol);
    if (!options.origin.empty()) request.set(http::field::origin, options.origin);
    if (!options.authorization.empty()) request.set(http::field::authorization, options.authorization);
  }));
  state_->stream.read_message_max(std::size_t{256} << 20);
  websocket::response_type response;
  error_code error;
  state_->stream.handshake(response, "127.0.0.1:" + std::to_string(port), target, error);
  const auto subprotocol = response[http::field::sec_websocket_protocol];
  state_->subprotocol.assign(subprotocol.data(), subprotocol.size());
  return static_cast<int>(response.result_int());
}

const std::string& WebSocketClient::subprotocol() const {
  return state_->subprotocol;
}

void WebSocketClient::send_text(const std::string& text) {
  error_code ignored;
  state_->stream.text(true);
  state_->stream.write(asio::buffer(text), ignored);
}

void WebSocketClient::send_binary(const std::string& bytes) {
  error_code ignored;
  state_->stream.binary(true);
  state_->stream.write(asio::buffer(bytes), ignored);
}

void WebSocketClient::send_raw(const std::string& bytes) {
  error_code ignored;
  asio::write(state_->stream.next_layer(), asio::buffer(bytes), ignored);
}

std::optional<Message> WebSocketClient::receive(std::chrono::milliseconds limit) {
  if (state_->ended) return {};
  if (!state_->reading) {
    state_->reading = true;
    state_->stream.async_read(state_->buffer, [state = state_.get()](error_code error, std::size_t) {
      state->reading = false;
      state->read_error = error;
    });
  }
  state_->run(limit, [this] { return !state_->reading; });
  if (state_->reading) return {};
  state_->ended = static_cast<bool>(state_->read_error);
  if (state_->ended) return {};
  const auto data = state_->buffer.data();
  Message message{state_->stream.got_text(), std::string(static_cast<const char*>(data.data()), data.size())};
  state_->buffer.clear();
  return message;
}

int WebSocketClient::close_code() const {
  if (!state_->ended) return 0;
  return state_->read_error == websocket::error::closed ? state_->stream.reason().code : 1006;
}

std::string WebSocketClient::close_reason() const {
  const auto& reason = state_->stream.reason().reason;
  return {reason.data(), reason.size()};
}

void WebSocketClient::close() {
  error_code ignored;
  if (!state_->reading) state_->stream.close(websocket::close_code::normal, ignored);
}

void WebSocketClient::cut() {
  error_code ignored;
  state_->stream.next_layer().close(ignored);
  state_->ended = true;
}

}  // namespace lightwell::test
