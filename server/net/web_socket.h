// A WebSocket on a stream whose handshake request has been read. Private to the connection layer: includes Asio.
#pragma once

#include <memory>
#include <utility>

// <utility> before Asio: its 1.74 forgets it.
#include <boost/asio/awaitable.hpp>

#include "server/net/shared.h"

namespace lightwell::net {

/// The server's end of a conversation.
class WebSocketEnd {
 public:
  virtual ~WebSocketEnd() = default;
  /// Answers the handshake and serves the conversation until it ends. Called once. `early_bytes`: the client sent data
  /// before the handshake was answered, which no honest client does.
  virtual boost::asio::awaitable<void> run(const RequestHead& head, bool early_bytes) = 0;
  /// Ends the conversation for its handler, and lets go of it; afterwards nothing is run on the stream's strand.
  virtual void let_go() = 0;
};

std::shared_ptr<WebSocketEnd> make_web_socket(TcpStream stream, WebSocketAdmission admission,
                                              std::shared_ptr<Shared> shared);
std::shared_ptr<WebSocketEnd> make_web_socket(TlsStream stream, WebSocketAdmission admission,
                                              std::shared_ptr<Shared> shared);

}  // namespace lightwell::net
