// A WebSocket on a stream whose handshake request has been read. Private to the connection layer: includes Asio.
#pragma once

#include <utility>

// <utility> before Asio: its 1.74 forgets it.
#include <boost/asio/awaitable.hpp>

#include "server/net/shared.h"

namespace lightwell::net {

/// Answers the handshake and serves the conversation until it ends. `early_bytes`: the client sent data before the
/// handshake was answered, which no honest client does.
boost::asio::awaitable<void> serve_web_socket(TcpStream stream, const RequestHead& head, WebSocketAdmission admission,
                                              std::shared_ptr<Shared> shared, bool early_bytes);
boost::asio::awaitable<void> serve_web_socket(TlsStream stream, const RequestHead& head, WebSocketAdmission admission,
                                              std::shared_ptr<Shared> shared, bool early_bytes);

}  // namespace lightwell::net
