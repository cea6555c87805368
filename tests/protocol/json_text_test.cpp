#include "protocol/json_text.h"

#include <gtest/gtest.h>

namespace lightwell::protocol {
namespace {

using Json = nlohmann::json;

void expect_refused(std::string_view text, int status, const std::string& pointer, const JsonLimits& limits = {}) {
  SCOPED_TRACE(std::string(text.substr(0, 80)));
  const Decoded<Json> parsed = parse_json(text, limits);
  ASSERT_FALSE(parsed.ok());
  EXPECT_EQ(parsed.problem().status, status);
  EXPECT_EQ(parsed.problem().pointer, pointer);
}

TEST(JsonText, ReadsEveryKindOfValue) {
  const Decoded<Json> parsed =
      parse_json(R"( {"a":[null,true,-1,18446744073709551615,2.5e-3,"\u00e9\ud83d\ude00"],"b":{}} )");
  ASSERT_TRUE(parsed.ok());
  const Json expected{{"a", {nullptr, true, -1, 18446744073709551615ull, 2.5e-3, "é😀"}}, {"b", Json::object()}};
  EXPECT_EQ(*parsed, expected);
}

TEST(JsonText, NamesTheMemberThatAppearsTwice) {
  expect_refused(R"({"a":1,"a":1})", 400, "/a");
  expect_refused(R"({"a":[0,{"b":1,"c/d~":[],"c/d~":2}]})", 400, "/a/1/c~1d~0");
  EXPECT_TRUE(parse_json(R"([{"a":1},{"a":1}])").ok());
}

TEST(JsonText, RefusesWhatIsNoUtf8) {
  expect_refused("\"\xff\"", 400, "");
  expect_refused("\"\xc0\xaf\"", 400, "");          // overlong
  expect_refused("\"\xed\xa0\x80\"", 400, "");      // a surrogate
  expect_refused("\"\xf4\x90\x80\x80\"", 400, "");  // beyond U+10FFFF
  expect_refused("{\"\xe2\x82\":1}", 400, "");      // cut short
  EXPECT_TRUE(parse_json("\"\xe2\x82\xac\"").ok());
}

TEST(JsonText, LimitsDepth) {
  JsonLimits limits;
  limits.max_depth = 3;
  EXPECT_TRUE(parse_json("[[[1]]]", limits).ok());
  expect_refused("[[0,[[1]]]]", 400, "/0/1/0", limits);
  expect_refused(R"({"a":{"b":{"c":{}}}})", 400, "/a/b/c", limits);
  expect_refused(std::string(1'000'000, '['), 400, [] {
    std::string pointer;
    for (int i = 0; i < 32; ++i) pointer += "/0";
    return pointer;
  }());
}

TEST(JsonText, LimitsBytesAndValues) {
  JsonLimits limits;
  limits.max_bytes = 8;
  limits.max_values = 3;
  EXPECT_TRUE(parse_json("[1,2]   ", limits).ok());
  expect_refused("[1,2]    ", 413, "", limits);
  expect_refused("[1,2,3]", 413, "/2", limits);
}

TEST(JsonText, RefusesNumbersThatNoDoubleHolds) {
  expect_refused("1e309", 400, "");
  expect_refused("-1e309", 400, "");
  EXPECT_TRUE(parse_json("1e308").ok());
  EXPECT_TRUE(parse_json("1e-400").ok());  // rounds to 0
}

TEST(JsonText, WritesWhatIsNoUtf8Mended) {
  EXPECT_EQ(json_text(Json("a\xff")), "\"a\xef\xbf\xbd\"");
}

}  // namespace
}  // namespace lightwell::protocol
