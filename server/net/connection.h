// One connection, from its first byte to its last. Private to the connection layer: includes Asio.
#pragma once

#include "server/net/shared.h"

namespace lightwell::net {

/// Serves an accepted connection on its own strand until it ends. With `Shared::tls` it speaks TLS, and nothing else.
void serve_connection(TcpStream stream, Peer peer, std::shared_ptr<Shared> shared);

/// Answers 503 and closes: there are too many connections.
void refuse_connection(TcpStream stream, std::shared_ptr<Shared> shared);

}  // namespace lightwell::net
