// Requests whose heads are not well-formed, by the names of their refusals in the OpenAPI document.
#pragma once

#include <string>
#include <vector>

namespace lightwell::test {

struct MalformedHead {
  const char* name;
  std::string request;
};

/// `stream`: the path of a session's stream.
inline std::vector<MalformedHead> malformed_heads(const std::string& stream) {
  const std::string host = "Host: localhost\r\n", end = "\r\n", get = "GET / HTTP/1.1\r\n" + host,
                    post = "POST /v1/render HTTP/1.1\r\n" + host + "Content-Type: application/json\r\n",
                    upgrade = " HTTP/1.1\r\n" + host + "Connection: Upgrade\r\nUpgrade: websocket\r\n",
                    key = "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n", thirteen = "Sec-WebSocket-Version: 13\r\n";
  return {
      {"request_line", "GET\r\n" + host + end},
      {"request_version", "GET / HTPP/1.1\r\n" + host + end},
      {"request_method", "G\"T / HTTP/1.1\r\n" + host + end},
      {"target_path", "GET hello HTTP/1.1\r\n" + host + end},
      {"target_fragment", "GET /#x HTTP/1.1\r\n" + host + end},
      {"target_escape", "GET /%zz HTTP/1.1\r\n" + host + end},
      {"target_character", "GET /\xc3\xbc HTTP/1.1\r\n" + host + end},
      {"target_star", "GET * HTTP/1.1\r\n" + host + end},
      {"field_name", get + "X[]: 1\r\n" + end},
      {"field_folded", get + "X: 1\r\n 2\r\n" + end},
      {"field_control", get + "X: \x07\r\n" + end},
      {"host_missing", "GET / HTTP/1.1\r\n" + end},
      {"host_twice", get + host + end},
      {"host_form", "GET / HTTP/1.1\r\nHost: a b\r\n" + end},
      {"length_twice", post + "Content-Length: 2\r\nContent-Length: 3\r\n" + end},
      {"length_number", post + "Content-Length: two\r\n" + end},
      {"length_and_chunks", post + "Content-Length: 2\r\nTransfer-Encoding: chunked\r\n" + end},
      {"chunks_of_old", "POST / HTTP/1.0\r\n" + host + "Transfer-Encoding: chunked\r\n" + end},
      {"chunks_twice", post + "Transfer-Encoding: chunked, chunked\r\n" + end},
      {"chunk_size", post + "Transfer-Encoding: chunked\r\n" + end + "zz\r\n"},
      {"socket_method", "POST " + stream + upgrade + key + thirteen + "Content-Length: 0\r\n" + end},
      {"socket_key", "GET " + stream + upgrade + "Sec-WebSocket-Key: short\r\n" + thirteen + end},
      {"socket_version", "GET " + stream + upgrade + key + "Sec-WebSocket-Version: 8\r\n" + end},
      {"subprotocol", "GET " + stream + upgrade + key + thirteen + "Sec-WebSocket-Protocol: chat\r\n" + end},
  };
}

}  // namespace lightwell::test
