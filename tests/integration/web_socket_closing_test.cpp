// WebSocket conformance: how a conversation is closed.
#include "tests/integration/web_socket_fixture.h"

namespace lightwell::test {
namespace {

TEST_F(WebSocketTest, Closing) {
  const std::string longest(123, '*');
  std::vector<Case> cases{
      {"without a status", {{kClose, ""}}, {}, 1000, false},
      {"half a status", {{kClose, "\x03"}}, {}, 1002},
      {"a reason", {close_frame(1000, "Hello")}, {}, 1000, false},
      {"the longest reason", {close_frame(1000, longest)}, {}, 1000, false},
      {"too long a reason", {close_frame(1000, longest + "x")}, {}, 1002},
      {"a reason that is no UTF-8", {close_frame(1000, "\xce\xba\xed\xa0\x80")}, {}, 1002},
      {"nothing counts after it", {close_frame(1000), {kText, "late"}, {kPing, "late"}}, {}, 1000, false},
      {"a second one", {close_frame(1000), close_frame(1000)}, {}, 1000, false},
      {"in the midst of a message", {{kText, "x", false}, close_frame(1000)}, {}, 1000, false},
  };
  for (const int code : {1000, 1001, 1002, 1003, 1007, 1008, 1009, 1010, 1011, 3000, 3999, 4000, 4999})
    cases.push_back({"code " + std::to_string(code), {close_frame(code)}, {}, code, false});
  for (const int code : {0, 999, 1004, 1005, 1006, 1016, 1100, 2000, 2999})
    cases.push_back({"code " + std::to_string(code), {close_frame(code)}, {}, 1002});
  check(cases);
}

}  // namespace
}  // namespace lightwell::test
