// protocol/golden_vectors.json, which web_client/protocol.js is held to as well.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "protocol/codec.h"
#include "protocol/frame_header.h"

namespace lightwell::protocol {
namespace {

using Json = nlohmann::json;

const Json& vectors() {
  static const Json loaded = [] {
    std::ifstream file(LIGHTWELL_GOLDEN_VECTORS);
    return Json::parse(file);
  }();
  return loaded;
}

std::vector<std::uint8_t> bytes_of(const std::string& hex) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes.push_back(static_cast<std::uint8_t>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  return bytes;
}

FrameHeader header_of(const Json& json) {
  FrameHeader header;
  const std::string codec = json.at("codec");
  header.codec = codec == "jpeg" ? FrameCodec::kJpeg : codec == "png" ? FrameCodec::kPng : FrameCodec::kH264;
  header.is_key = json.at("is_key").get<bool>();
  header.is_final = json.at("is_final").get<bool>();
  header.is_lossless = json.at("is_lossless").get<bool>();
  header.frame = json.at("frame").get<std::uint32_t>();
  header.input_seq = json.at("input_seq").get<std::uint32_t>();
  header.scene_revision = std::stoull(json.at("scene_revision").get<std::string>());
  header.capture_ms = json.at("capture_ms").get<double>();
  header.scene_time_s = json.at("scene_time_s").get<float>();
  header.width = json.at("width").get<std::uint16_t>();
  header.height = json.at("height").get<std::uint16_t>();
  header.payload_bytes = json.at("payload_bytes").get<std::uint32_t>();
  header.render_ms = json.at("render_ms").get<float>();
  return header;
}

std::string text_of(const Json& vector) {
  return vector.contains("text") ? vector["text"].get<std::string>() : vector.at("message").dump();
}

template <class T>
void expect_meaning(const char* group, Decoded<T> (*parse)(std::string_view)) {
  ASSERT_FALSE(vectors().at(group).empty());
  for (const Json& vector : vectors().at(group)) {
    SCOPED_TRACE(vector.at("name"));
    const Decoded<T> parsed = parse(text_of(vector));
    ASSERT_TRUE(parsed.ok()) << to_json(parsed.problem());
    const Json written = to_json(*parsed);
    EXPECT_EQ(written, vector.contains("means") ? vector["means"] : vector["message"]);
    const Decoded<T> again = parse(json_text(written));
    ASSERT_TRUE(again.ok()) << to_json(again.problem());
    EXPECT_TRUE(*again == *parsed);
  }
}

template <class T>
void expect_problem(const char* group, Decoded<T> (*parse)(std::string_view)) {
  ASSERT_FALSE(vectors().at(group).empty());
  for (const Json& vector : vectors().at(group)) {
    SCOPED_TRACE(vector.at("name"));
    const Decoded<T> parsed = parse(text_of(vector));
    ASSERT_FALSE(parsed.ok()) << to_json(*parsed);
    EXPECT_EQ(parsed.problem().status, vector.at("status"));
    EXPECT_EQ(parsed.problem().pointer, vector.at("pointer"));
    EXPECT_FALSE(parsed.problem().detail.empty());
  }
}

TEST(GoldenVectors, FramesAreReadAndWritten) {
  for (const Json& vector : vectors().at("frames")) {
    SCOPED_TRACE(vector.at("name"));
    const std::vector<std::uint8_t> message = bytes_of(vector.at("bytes"));
    const FrameHeader header = header_of(vector.at("header"));
    const Decoded<DecodedFrame> frame = decode_frame(message);
    ASSERT_TRUE(frame.ok()) << frame.problem().detail;
    EXPECT_TRUE(frame->header == header);
    EXPECT_EQ(frame->payload.data(), message.data() + kFrameHeaderBytes);
    EXPECT_EQ(frame->payload.size(), header.payload_bytes);
    const auto written = encode_frame_header(header);
    EXPECT_TRUE(std::equal(written.begin(), written.end(), message.begin()));
  }
}

TEST(GoldenVectors, FlagsOfTheFutureAreIgnored) {
  for (const Json& vector : vectors().at("lenient_frames")) {
    SCOPED_TRACE(vector.at("name"));
    const std::vector<std::uint8_t> message = bytes_of(vector.at("bytes"));
    const Decoded<DecodedFrame> frame = decode_frame(message);
    ASSERT_TRUE(frame.ok()) << frame.problem().detail;
    EXPECT_TRUE(frame->header == header_of(vector.at("header")));
  }
}

TEST(GoldenVectors, InvalidFramesAreRefused) {
  for (const Json& vector : vectors().at("invalid_frames")) {
    SCOPED_TRACE(vector.at("name"));
    const std::vector<std::uint8_t> message = bytes_of(vector.at("bytes"));
    const Decoded<DecodedFrame> frame = decode_frame(message);
    ASSERT_FALSE(frame.ok());
    EXPECT_EQ(frame.problem().detail, vector.at("detail"));
  }
}

TEST(GoldenVectors, ClientMessages) {
  expect_meaning<ClientMessage>("client_messages", parse_client_message);
}
TEST(GoldenVectors, ServerMessages) {
  expect_meaning<ServerMessage>("server_messages", parse_server_message);
}
TEST(GoldenVectors, RenderRequests) {
  expect_meaning<RenderRequest>("render_requests", parse_render_request);
}
TEST(GoldenVectors, SessionRequests) {
  expect_meaning<SessionRequest>("session_requests", parse_session_request);
}
TEST(GoldenVectors, SessionPatches) {
  expect_meaning<SessionPatch>("session_patches", parse_session_patch);
}

TEST(GoldenVectors, InvalidClientMessages) {
  expect_problem<ClientMessage>("invalid_client_messages", parse_client_message);
}
TEST(GoldenVectors, InvalidServerMessages) {
  expect_problem<ServerMessage>("invalid_server_messages", parse_server_message);
}
TEST(GoldenVectors, InvalidRenderRequests) {
  expect_problem<RenderRequest>("invalid_render_requests", parse_render_request);
}
TEST(GoldenVectors, InvalidSessionRequests) {
  expect_problem<SessionRequest>("invalid_session_requests", parse_session_request);
}
TEST(GoldenVectors, InvalidSessionPatches) {
  expect_problem<SessionPatch>("invalid_session_patches", parse_session_patch);
}

}  // namespace
}  // namespace lightwell::protocol
