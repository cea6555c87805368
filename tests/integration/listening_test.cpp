// Where a server may listen, and why it cannot begin to.
#include <gtest/gtest.h>

#include "server/net/server.h"

namespace lightwell::test {
namespace {

TEST(Listening, NamesAPortThatIsTaken) {
  const net::Server first{net::ServerOptions()};
  net::ServerOptions options;
  options.port = first.port();
  try {
    const net::Server second(options);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("127.0.0.1:" + std::to_string(first.port())), std::string::npos);
  }
}

TEST(Loopback, IsTheOnlyPlaceWithoutLeave) {
  net::ServerOptions options;
  options.host = "0.0.0.0";
  try {
    const net::Server server(options);
    FAIL() << "it listens";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("0.0.0.0:0: other machines reach this address"), std::string::npos);
  }
  options.loopback_only = false;
  EXPECT_GT(net::Server(options).port(), 0);
}

TEST(Tls, NamesAFileThatIsNoCertificate) {
  net::ServerOptions options;
  options.tls_certificate = options.tls_key = "/dev/null";
  try {
    const net::Server server(options);
    FAIL() << "it listens";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("/dev/null"), std::string::npos);
  }
}

}  // namespace
}  // namespace lightwell::test
