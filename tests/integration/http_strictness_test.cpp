// HTTP/1.1 as strict as RFC 9112 has it, over a real socket: cases like those of the public h1spec table, and more.
#include <gtest/gtest.h>

#include "tests/integration/echo_application.h"
#include "tests/integration/line.h"

namespace lightwell::test {
namespace {

using namespace std::string_literals;

struct Case {
  const char* name;
  std::vector<std::string> pieces;  // sent one after another
  int status;                       // of the answer
};

const Case kCases[] = {
    // Pieces
    {"a method in pieces", {"G", "ET / HTTP/1.1\r\nHost: a\r\n\r\n"}, 200},
    {"a target in pieces", {"GET /he", "llo HTTP/1.1\r\nHost: a\r\n\r\n"}, 200},
    {"before the target", {"GET ", "/hello HTTP/1.1\r\nHost: a\r\n\r\n"}, 200},
    {"a version in pieces", {"GET /hello HT", "TP/1.1\r\nHost: a\r\n\r\n"}, 200},
    {"a request line in pieces", {"GET /hello HTTP/1.1\r", "\nHost: a\r\n\r\n"}, 200},
    {"a field's name in pieces", {"GET /hello HTTP/1.1\r\nHo", "st: a\r\n\r\n"}, 200},
    {"a field's value in pieces", {"GET /hello HTTP/1.1\r\nHost: localh", "ost\r\n\r\n"}, 200},
    {"a field's end in pieces", {"GET / HTTP/1.1\r\nHost: a\r", "\n\r\n"}, 200},
    {"the empty line in pieces", {"GET / HTTP/1.1\r\nHost: a\r\n", "\r", "\n"}, 200},
    {"a body in pieces", {"POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\n\r\nhe", "llo"}, 200},
    {"chunks in pieces",
     {"POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n5", "\r\nhel", "lo\r\n0\r\n", "\r\n"},
     200},
    // What is good
    {"GET", {"GET / HTTP/1.1\r\nHost: a\r\n\r\n"}, 200},
    {"a query", {"GET /hello?true=1 HTTP/1.1\r\nHost: a\r\n\r\n"}, 200},
    {"an absolute target", {"GET http://a/hello HTTP/1.1\r\nHost: a\r\n\r\n"}, 200},
    {"POST without a body", {"POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 0\r\n\r\n"}, 200},
    {"POST with a body", {"POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\n\r\nhello"}, 200},
    {"an empty value", {"GET / HTTP/1.1\r\nHost: a\r\nX-Empty:\r\n\r\n"}, 200},
    {"blanks around a value", {"GET / HTTP/1.1\r\nHost:  \t a \t \r\n\r\n"}, 200},
    {"names in any case", {"GET / HTTP/1.1\r\nhOST: a\r\ncONTENT-lENGTH: 0\r\n\r\n"}, 200},
    {"bytes beyond ASCII in a value", {"GET / HTTP/1.1\r\nHost: a\r\nX: \xc3\xbc\r\n\r\n"}, 200},
    {"chunks with extensions and trailers",
     {"POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n5;x=y\r\nhello\r\n0\r\nT: v\r\n\r\n"},
     200},
    {"the length twice, alike",
     {"POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\nContent-Length: 5\r\n\r\nhello"},
     400},
    // What is not
    {"no Host", {"GET / HTTP/1.1\r\n\r\n"}, 400},
    {"Host twice", {"GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n"}, 400},
    {"a name with a space before the colon", {"GET / HTTP/1.1\r\nHost : a\r\n\r\n"}, 400},
    {"a name with a space in it", {"GET / HTTP/1.1\r\nHost: a\r\nX y: 1\r\n\r\n"}, 400},
    {"a name of no letters", {"GET / HTTP/1.1\r\nHost: a\r\n: empty\r\n\r\n"}, 400},
    {"a name with a forbidden character", {"GET / HTTP/1.1\r\nHost: a\r\nX[]: 1\r\n\r\n"}, 400},
    {"a field without a colon", {"GET / HTTP/1.1\r\nHost: a\r\nnothing\r\n\r\n"}, 400},
    {"a folded field", {"GET / HTTP/1.1\r\nHost: a\r\nX: 1\r\n 2\r\n\r\n"}, 400},
    {"white space before the first field", {"GET / HTTP/1.1\r\n Host: a\r\n\r\n"}, 400},
    {"a zero byte in a value", {"GET / HTTP/1.1\r\nHost: a\r\nX: \0\r\n\r\n"s}, 400},
    {"a control character in a value", {"GET / HTTP/1.1\r\nHost: a\r\nX: \x07\r\n\r\n"}, 400},
    {"a lone CR in a value", {"GET / HTTP/1.1\r\nHost: a\r\nX: a\rb\r\n\r\n"}, 400},
    {"a lone LF at a line's end", {"GET / HTTP/1.1\r\nHost: a\nX: 1\r\n\r\n"}, 400},
    {"LF alone", {"GET / HTTP/1.1\nHost: a\n\n"}, 400},
    {"no version", {"GET /\r\nHost: a\r\n\r\n"}, 400},
    {"a version of letters", {"GET / HTTP/x.y\r\nHost: a\r\n\r\n"}, 400},
    {"a version in small letters", {"GET / http/1.1\r\nHost: a\r\n\r\n"}, 400},
    {"two spaces", {"GET  / HTTP/1.1\r\nHost: a\r\n\r\n"}, 400},
    {"a word too many", {"GET / HTTP/1.1 x\r\nHost: a\r\n\r\n"}, 400},
    {"a method of no letters", {"G\"T / HTTP/1.1\r\nHost: a\r\n\r\n"}, 400},
    {"a target with a fragment", {"GET /#x HTTP/1.1\r\nHost: a\r\n\r\n"}, 400},
    {"a target that is no path", {"GET hello HTTP/1.1\r\nHost: a\r\n\r\n"}, 400},
    {"a space before the method", {" GET / HTTP/1.1\r\nHost: a\r\n\r\n"}, 400},
    {"a negative length", {"POST / HTTP/1.1\r\nHost: a\r\nContent-Length: -5\r\n\r\n"}, 400},
    {"a length with a plus", {"POST / HTTP/1.1\r\nHost: a\r\nContent-Length: +5\r\n\r\nhello"}, 400},
    {"a length of letters", {"POST / HTTP/1.1\r\nHost: a\r\nContent-Length: five\r\n\r\nhello"}, 400},
    {"a length in hexadecimal", {"POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 0x5\r\n\r\nhello"}, 400},
    {"a length beyond numbers", {"POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 99999999999999999999\r\n\r\n"}, 400},
    {"an empty length", {"POST / HTTP/1.1\r\nHost: a\r\nContent-Length:\r\n\r\n"}, 400},
    {"two lengths", {"POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\nContent-Length: 6\r\n\r\nhello"}, 400},
    {"a list of lengths", {"POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 5, 6\r\n\r\nhello"}, 400},
    {"a length and chunks",
     {"POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 5\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n"},
     400},
    {"chunks in HTTP/1.0", {"POST / HTTP/1.0\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n"}, 400},
    {"chunks within chunks",
     {"POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked, chunked\r\n\r\n0\r\n\r\n"},
     400},
    {"another coding after chunks",
     {"POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked, gzip\r\n\r\n0\r\n\r\n"},
     400},
    {"a chunk's size of letters",
     {"POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\nxyz\r\nhello\r\n0\r\n\r\n"},
     400},
    {"a negative chunk",
     {"POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n-5\r\nhello\r\n0\r\n\r\n"},
     400},
    {"a chunk in 0x",
     {"POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n0x5\r\nhello\r\n0\r\n\r\n"},
     400},
    {"a chunk longer than its size",
     {"POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n3\r\nhello\r\n0\r\n\r\n"},
     400},
    {"a chunk that ends in LF alone",
     {"POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n5\r\nhello\n0\r\n\r\n"},
     400},
    {"a coding nobody knows", {"POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: gzip\r\n\r\n"}, 501},
    {"HTTP/2 in words", {"GET / HTTP/2.0\r\nHost: a\r\n\r\n"}, 505},
};

TEST(HttpStrictness, OfTheWholeTable) {
  net::Server server{net::ServerOptions()};
  EchoApplication application(1u << 20);
  server.start(application);
  for (const Case& one : kCases) {
    SCOPED_TRACE(one.name);
    Line line(server.port());
    for (const std::string& piece : one.pieces) {
      line.send(piece);
      if (one.pieces.size() > 1) std::this_thread::sleep_for(std::chrono::milliseconds(2));  // a packet of its own
    }
    EXPECT_EQ(read_answer(line).status, one.status);
    if (one.status == 200) {  // the line can be used again: nothing was left over
      line.send("GET /next HTTP/1.1\r\nHost: a\r\n\r\n");
      EXPECT_EQ(read_answer(line).body, "GET /next");
    } else {  // what comes after is not taken for a request
      line.receive_all();
      EXPECT_TRUE(line.closed());
    }
  }
  server.stop();
}

}  // namespace
}  // namespace lightwell::test
