// WebSocket conformance: texts are UTF-8, however they are cut into frames.
#include "tests/integration/web_socket_fixture.h"

namespace lightwell::test {
namespace {

using namespace std::string_literals;

const std::string kGreek = "\xce\xba\xe1\xbd\xb9\xcf\x83\xce\xbc\xce\xb5";

TEST_F(WebSocketTest, TextIsUtf8) {
  std::vector<Case> cases;
  const std::string good[] = {"Hello-\xc2\xb5@\xc3\x9f\xc3\xb6\xc3\xa4\xc3\xbc\xc3\xa0\xc3\xa1-UTF-8!!",
                              kGreek,
                              "\0"s,
                              "\x7f",
                              "\xc2\x80",
                              "\xdf\xbf",
                              "\xe0\xa0\x80",
                              "\xed\x9f\xbf",
                              "\xee\x80\x80",
                              "\xef\xbf\xbd",
                              "\xef\xbf\xbe",
                              "\xef\xbf\xbf",
                              "\xf0\x90\x80\x80",
                              "\xf0\x9f\xbf\xbf",
                              "\xf4\x8f\xbf\xbf"};
  const std::string bad[] = {"\x80",
                             "\xbf",
                             "\xc0\x80",
                             "\xc1\xbf",
                             "\xc3",
                             "\xc3\x28",
                             "\xe0\x80\x80",
                             "\xe0\x9f\xbf",
                             "\xe1\x80",
                             "\xed\xa0\x80",
                             "\xed\xbf\xbf",
                             "\xed\xa0\x80\xed\xb0\x80",
                             "\xf0\x80\x80\x80",
                             "\xf0\x8f\xbf\xbf",
                             "\xf4\x90\x80\x80",
                             "\xf5\x80\x80\x80",
                             "\xf8\x88\x80\x80\x80",
                             "\xfc\x84\x80\x80\x80\x80",
                             "\xfe",
                             "\xff",
                             kGreek + "\xed\xa0\x80" + "edited"};
  for (const std::string& text : good) {
    cases.push_back({"good " + text, {{kText, text}}, {{kText, text}}});
    std::vector<Frame> bytewise{{kText, "", false}};
    for (const char byte : text) bytewise.push_back({kMore, std::string(1, byte), false});
    bytewise.push_back({kMore, ""});
    cases.push_back({"good in pieces " + text, bytewise, {{kText, text}}});
  }
  for (const std::string& text : bad) {
    cases.push_back({"bad " + text, {{kText, text}}, {}, 1007});
    cases.push_back({"bad in two " + text, {{kText, text.substr(0, 1), false}, {kMore, text.substr(1)}}, {}, 1007});
    cases.push_back({"bytes may be anything " + text, {{kBinary, text}}, {{kBinary, text}}});
  }
  check(cases);
  check(cases, 1);
  // It is refused as soon as it cannot become right, not at the message's end.
  Line line = open();
  line.send(bytes_of({kText, kGreek + "\xf4\x90", false}));
  EXPECT_EQ(listen(line).code, 1007);
}

}  // namespace
}  // namespace lightwell::test
