// An echo server on the connection layer, for conformance suites from outside: echo_server [PORT], until it is killed.
#include <unistd.h>

#include <cstdlib>
#include <iostream>

#include "tests/integration/echo_application.h"

int main(int count, char** arguments) {
  constexpr std::uint64_t kMostBytes = 64u << 20;  // suites send up to 16 MiB in one message
  lightwell::net::ServerOptions options;
  options.port = count > 1 ? std::atoi(arguments[1]) : 9001;
  try {
    lightwell::net::Server server(options);
    lightwell::test::EchoApplication application(kMostBytes);
    server.start(application);
    std::cout << "ws://127.0.0.1:" << server.port() << std::endl;
    ::pause();
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
