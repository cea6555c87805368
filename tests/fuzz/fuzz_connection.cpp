// The connection layer over a real socket. The first byte says how: as the bytes of a connection, as those of a
// WebSocket, or as frames of one, masked and with the lengths that they say (a byte of flags and opcode, a byte of
// length, the payload). Whatever comes, the connection ends when the client's side does, and the next is served.
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <string>
#include <string_view>

#include "tests/integration/echo_application.h"
#include "tests/integration/line.h"

namespace lightwell::test {
namespace {

constexpr std::uint64_t kMostBytes = 4096;

[[noreturn]] void fail(std::string_view what) {
  std::cerr << what << '\n';
  std::abort();
}

struct EchoServer {
  EchoServer() : application(kMostBytes), server(net::ServerOptions()) { server.start(application); }
  EchoApplication application;
  net::Server server;
};

std::string as_frames(std::string_view text) {
  std::string bytes;
  while (text.size() >= 2) {
    const auto size = std::min<std::size_t>(static_cast<unsigned char>(text[1]), text.size() - 2);
    bytes.push_back(text[0]);
    if (size < 126) {
      bytes.push_back(static_cast<char>(0x80 | size));
    } else {
      bytes.push_back('\xfe');
      bytes.append({static_cast<char>(size >> 8), static_cast<char>(size & 0xff)});
    }
    bytes.append(4, '\0');  // a mask that changes nothing
    bytes.append(text.substr(2, size));
    text.remove_prefix(2 + size);
  }
  return bytes;
}

void open_web_socket(Line& line) {
  line.send(
      "GET / HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
  if (!line.receive_until("\r\n\r\n").starts_with("HTTP/1.1 101 ")) fail("a WebSocket is not opened");
}

void converse(std::uint8_t how, std::string_view bytes) {
  static EchoServer echo;
  Line line(echo.server.port());
  if (how % 3 != 0) open_web_socket(line);
  const std::string sent = how % 3 == 2 ? as_frames(bytes) : std::string(bytes);
  const std::size_t cut = how / 3 % 2 == 1 ? sent.size() / 2 : sent.size();
  line.send(std::string_view(sent).substr(0, cut));
  line.send(std::string_view(sent).substr(cut));
  line.shut_down_sending();
  const std::string answer = line.receive_all();
  if (!line.closed()) fail("a connection that nobody holds stays open");
  if (how % 3 == 0 && !answer.empty() && !answer.starts_with("HTTP/1.1 ")) fail("no answer of HTTP's");
}

}  // namespace
}  // namespace lightwell::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size > 0) lightwell::test::converse(data[0], {reinterpret_cast<const char*>(data + 1), size - 1});
  return 0;
}
