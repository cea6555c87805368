#include "server/net/request_head.h"

#include <gtest/gtest.h>

namespace lightwell::net {
namespace {

using Parsed = std::variant<RequestHead, Refusal>;

Parsed parse(const std::string& text) {
  return parse_request_head(text);
}

/// The status of a refusal; 0 if the head is good.
int status_of(const std::string& text) {
  const Parsed parsed = parse(text);
  const auto* refusal = std::get_if<Refusal>(&parsed);
  return refusal ? refusal->status : 0;
}

/// A GET with one more field.
int status_with(const std::string& field) {
  return status_of("GET / HTTP/1.1\r\nHost: a\r\n" + field + "\r\n\r\n");
}

RequestHead good(const std::string& text) {
  const Parsed parsed = parse(text);
  const auto* refusal = std::get_if<Refusal>(&parsed);
  EXPECT_EQ(refusal, nullptr) << (refusal ? refusal->detail : "");
  return refusal ? RequestHead() : std::get<RequestHead>(parsed);
}

TEST(RequestHead, ReadsAPlainRequest) {
  const RequestHead head = good("GET /v1/scenes?x=1&y=%20 HTTP/1.1\r\nHost: localhost:80\r\nAccept:  */* \r\n\r\n");
  EXPECT_EQ(head.method, "GET");
  EXPECT_EQ(head.path, "/v1/scenes");
  EXPECT_EQ(head.query, "x=1&y=%20");
  EXPECT_EQ(head.field("accept"), "*/*");
  EXPECT_TRUE(head.keep_alive);
  EXPECT_EQ(head.framing, Framing::kNone);
}

TEST(RequestHead, ReadsAbsoluteFormAsteriskAndEscapes) {
  EXPECT_EQ(good("GET http://other/a/b?c HTTP/1.1\r\nHost: a\r\n\r\n").path, "/a/b");
  EXPECT_EQ(good("OPTIONS * HTTP/1.1\r\nHost: a\r\n\r\n").path, "*");
  EXPECT_EQ(good("GET /%41%2f HTTP/1.1\r\nHost: a\r\n\r\n").path, "/A/");
}

TEST(RequestHead, ForgivesOneEmptyLineBefore) {
  EXPECT_EQ(status_of("\r\nGET / HTTP/1.1\r\nHost: a\r\n\r\n"), 0);
}

TEST(RequestHead, RefusesBrokenRequestLines) {
  for (const char* line : {"GET /", "GET  HTTP/1.1", "GET / HTTP/1.1 x", " GET / HTTP/1.1", "G@T / HTTP/1.1",
                           "GET / http/1.1", "GET / HTTP/1", "GET / HTTP/1.1x", "GET a HTTP/1.1", "GET /a b HTTP/1.1",
                           "GET /\x80 HTTP/1.1", "GET /%4 HTTP/1.1", "GET /%zz HTTP/1.1", "GET /%00 HTTP/1.1",
                           "GET /#a HTTP/1.1", "GET * HTTP/1.1", "GET http:///a HTTP/1.1", ""})
    EXPECT_EQ(status_of(std::string(line) + "\r\nHost: a\r\n\r\n"), 400) << line;
  EXPECT_EQ(status_of("GET / HTTP/2.0\r\nHost: a\r\n\r\n"), 505);
  EXPECT_EQ(status_of("GET /" + std::string(5000, 'a') + " HTTP/1.1\r\nHost: a\r\n\r\n"), 414);
}

TEST(RequestHead, RefusesBrokenFields) {
  for (const char* field :
       {"A : b", " A: b", "A b: c", ": b", "A", "A: \x01", "A: b\x7f", "A\xc3: b", "A: b\r\n folded"})
    EXPECT_EQ(status_with(field), 400) << field;
  EXPECT_EQ(status_with("A: tab\there"), 0);
  EXPECT_EQ(status_with("A:"), 0);
  EXPECT_EQ(status_with("A: \xc3\xa9"), 0);  // obs-text
  std::string many;
  for (int i = 0; i < 100; ++i) many += "A: b\r\n";
  EXPECT_EQ(status_with(many + "B: c"), 431);
  EXPECT_EQ(status_with("A: " + std::string(20'000, 'b')), 431);
}

TEST(RequestHead, WantsExactlyOneHost) {
  EXPECT_EQ(status_of("GET / HTTP/1.1\r\n\r\n"), 400);
  EXPECT_EQ(status_of("GET / HTTP/1.0\r\n\r\n"), 0);
  EXPECT_EQ(status_with("Host: a"), 400);
  EXPECT_EQ(status_of("GET / HTTP/1.1\r\nHost: a b\r\n\r\n"), 400);
  EXPECT_EQ(status_of("GET / HTTP/1.1\r\nHost: [::1]:8080\r\n\r\n"), 0);
}

TEST(RequestHead, WantsOneClearFraming) {
  EXPECT_EQ(good("POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 12\r\n\r\n").content_length, 12u);
  EXPECT_EQ(good("POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: Chunked\r\n\r\n").framing, Framing::kChunked);
  for (const char* field :
       {"Content-Length: -1", "Content-Length: +1", "Content-Length: 1x", "Content-Length:", "Content-Length: 1, 1",
        "Content-Length: 1\r\nContent-Length: 1", "Content-Length: 99999999999999999999", "Content-Length: 0x10",
        "Content-Length: 1\r\nTransfer-Encoding: chunked"})
    EXPECT_EQ(status_with(field), 400) << field;
  EXPECT_EQ(status_with("Transfer-Encoding: gzip, chunked"), 501);
  EXPECT_EQ(status_with("Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked"), 400);
  EXPECT_EQ(status_with("Transfer-Encoding: chunked, gzip"), 400);
  EXPECT_EQ(status_with("Content-Encoding: gzip"), 415);
  EXPECT_EQ(status_with("Expect: a miracle"), 417);
  EXPECT_EQ(status_of("POST / HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n"), 400);
}

TEST(RequestHead, KeepsAliveUnlessToldOtherwise) {
  EXPECT_FALSE(good("GET / HTTP/1.1\r\nHost: a\r\nConnection: foo, Close\r\n\r\n").keep_alive);
  EXPECT_FALSE(good("GET / HTTP/1.0\r\nHost: a\r\n\r\n").keep_alive);
}

TEST(RequestHead, KnowsACompleteWebSocketHandshake) {
  const std::string start = "GET / HTTP/1.1\r\nHost: a\r\nUpgrade: websocket\r\nConnection: keep-alive, Upgrade\r\n";
  const std::string key = "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
  const std::string version = "Sec-WebSocket-Version: 13\r\n";
  EXPECT_TRUE(good(start + key + version + "\r\n").wants_web_socket);
  EXPECT_EQ(status_of(start + key + "\r\n"), 426);
  EXPECT_EQ(status_of(start + key + "Sec-WebSocket-Version: 8\r\n\r\n"), 426);
  EXPECT_EQ(status_of(start + version + "\r\n"), 400);
  EXPECT_EQ(status_of(start + "Sec-WebSocket-Key: short\r\n" + version + "\r\n"), 400);
  EXPECT_FALSE(good("GET / HTTP/1.1\r\nHost: a\r\nUpgrade: h2c\r\nConnection: Upgrade\r\n\r\n").wants_web_socket);
}

TEST(HeadEnd, IsFoundInWhateverPieces) {
  const std::string text = "GET / HTTP/1.1\r\nHost: a\r\n\r\nbody";
  for (std::size_t cut = 0; cut < text.size(); ++cut) {
    const HeadScan part = find_head_end(text.substr(0, cut), 0);
    const bool complete = cut >= text.size() - 4;
    EXPECT_EQ(part.state, complete ? HeadScan::State::kComplete : HeadScan::State::kIncomplete) << cut;
    if (complete) continue;
    const HeadScan whole = find_head_end(text, cut);
    EXPECT_EQ(whole.state, HeadScan::State::kComplete);
    EXPECT_EQ(whole.head_bytes, text.size() - 4);
  }
}

TEST(HeadEnd, GivesUpOnWhatIsNoHead) {
  using namespace std::string_literals;
  for (const std::string& text :
       {"GET / HTTP/1.1\n\n"s, "GET / HTTP/1.1\r\nA: b\rc\r\n\r\n"s, "\x16\x03\x01"s, "GET \0"s})
    EXPECT_EQ(find_head_end(text, 0).state, HeadScan::State::kBroken);
}

}  // namespace
}  // namespace lightwell::net
