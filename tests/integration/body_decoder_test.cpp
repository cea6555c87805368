#include "server/net/body_decoder.h"

#include <gtest/gtest.h>

namespace lightwell::net {
namespace {

RequestHead chunked() {
  RequestHead head;
  head.framing = Framing::kChunked;
  return head;
}

RequestHead length(std::uint64_t bytes) {
  RequestHead head;
  head.framing = Framing::kLength;
  head.content_length = bytes;
  return head;
}

/// Status of the failure, 0 if none, after feeding everything in pieces of `step` bytes.
int feed(BodyDecoder& decoder, const std::string& text, std::size_t step) {
  for (std::size_t at = 0; at < text.size() && !decoder.done() && !decoder.failure();)
    at += decoder.feed(std::string_view(text).substr(at, step));
  return decoder.failure() ? decoder.failure()->status : 0;
}

TEST(BodyDecoder, TakesJustTheLengthAnnounced) {
  BodyDecoder decoder(length(5), 10);
  EXPECT_EQ(decoder.feed("helloworld"), 5u);
  EXPECT_TRUE(decoder.done());
  EXPECT_EQ(decoder.take_body(), "hello");
}

TEST(BodyDecoder, IsDoneAtOnceWithoutABody) {
  EXPECT_TRUE(BodyDecoder(RequestHead(), 0).done());
  EXPECT_TRUE(BodyDecoder(length(0), 0).done());
}

TEST(BodyDecoder, RefusesTooMuchBeforeReadingIt) {
  const BodyDecoder decoder(length(11), 10);
  ASSERT_TRUE(decoder.failure());
  EXPECT_EQ(decoder.failure()->status, 413);
}

TEST(BodyDecoder, JoinsChunksInWhateverPieces) {
  const std::string text = "5;name=value\r\nhello\r\n6\r\n world\r\n0\r\nTrailer: x\r\n\r\nnext";
  for (std::size_t step = 1; step < text.size(); ++step) {
    BodyDecoder decoder(chunked(), 100);
    EXPECT_EQ(feed(decoder, text, step), 0);
    EXPECT_TRUE(decoder.done());
    EXPECT_EQ(decoder.take_body(), "hello world");
  }
}

TEST(BodyDecoder, RefusesBrokenChunks) {
  for (const char* text : {"x\r\n", "\r\n", "-1\r\n", "0x1\r\n", "ffffffffffffffff\r\n", "5\nhello", "5\r\nhelloo\r\n",
                           "5\r\nhello\n", "1 \r\na\r\n"}) {
    BodyDecoder decoder(chunked(), 100);
    const int status = feed(decoder, text, 1);
    EXPECT_TRUE(status == 400 || status == 413) << text << status;
  }
  BodyDecoder decoder(chunked(), 100);
  EXPECT_EQ(feed(decoder, "1;" + std::string(1000, 'a'), 7), 400);
}

TEST(BodyDecoder, CountsChunksTogether) {
  BodyDecoder decoder(chunked(), 8);
  EXPECT_EQ(feed(decoder, "5\r\nhello\r\n4\r\nmore\r\n", 100), 413);
}

TEST(BodyDecoder, BoundsTrailers) {
  std::string text = "0\r\n";
  for (int i = 0; i < 100; ++i) text += "Trailer: " + std::string(100, 'x') + "\r\n";
  BodyDecoder decoder(chunked(), 8);
  EXPECT_EQ(feed(decoder, text, 100), 431);
}

}  // namespace
}  // namespace lightwell::net
