// What the golden vectors cannot say: queries, numbers that do not travel, names.
#include "protocol/codec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "protocol/names.h"

namespace lightwell::protocol {
namespace {

using Query = std::vector<std::pair<std::string, std::string>>;

TEST(FrameQuery, EverythingMayBeLeftOut) {
  const Decoded<FrameQuery> parsed = parse_frame_query(Query{});
  ASSERT_TRUE(parsed.ok());
  EXPECT_TRUE(*parsed == FrameQuery{});
}

TEST(FrameQuery, ReadsAllMembers) {
  const Query query{{"format", "exr"}, {"width", "640"}, {"height", "480"}, {"view", "occlusion-distance"}};
  const Decoded<FrameQuery> parsed = parse_frame_query(query);
  ASSERT_TRUE(parsed.ok());
  EXPECT_EQ(parsed->format, ImageFormat::kExr);
  EXPECT_EQ(parsed->width, 640);
  EXPECT_EQ(parsed->height, 480);
  EXPECT_EQ(parsed->view, "occlusion-distance");
}

TEST(FrameQuery, NamesWhatIsWrong) {
  const std::vector<std::pair<Query, std::string>> cases{
      {{{"format", "gif"}}, "/format"}, {{{"format", ""}}, "/format"},
      {{{"width", "0"}}, "/width"},     {{{"width", "65536"}}, "/width"},
      {{{"width", "-1"}}, "/width"},    {{{"width", "1e2"}}, "/width"},
      {{{"width", "12px"}}, "/width"},  {{{"width", "99999999999999999999"}}, "/width"},
      {{{"height", ""}}, "/height"},    {{{"view", ""}}, "/view"},
      {{{"size", "1"}}, "/size"},       {{{"width", "1"}, {"width", "2"}}, "/width"},
      {{{"a/b", "1"}}, "/a~1b"},
  };
  for (const auto& [query, pointer] : cases) {
    SCOPED_TRACE(pointer + " " + query.front().second);
    const Decoded<FrameQuery> parsed = parse_frame_query(query);
    ASSERT_FALSE(parsed.ok());
    EXPECT_EQ(parsed.problem().pointer, pointer);
  }
}

TEST(Serialize, NumbersThatAreNotFiniteTravelAsZero) {
  Stats stats;
  stats.method = "thesis";
  stats.fps = std::nan("");
  stats.exposure_ev = -std::numeric_limits<double>::infinity();
  const Decoded<ServerMessage> read = parse_server_message(serialize(stats));
  ASSERT_TRUE(read.ok()) << read.problem().detail;
  EXPECT_EQ(std::get<Stats>(*read).fps, 0.0);
  EXPECT_EQ(std::get<Stats>(*read).exposure_ev, 0.0);
}

TEST(Serialize, NamesThatAreNoUtf8AreMended) {
  Bye bye;
  bye.reason = "\xff";
  const Decoded<ServerMessage> read = parse_server_message(serialize(bye));
  ASSERT_TRUE(read.ok()) << read.problem().detail;
  EXPECT_EQ(std::get<Bye>(*read).reason, "\xef\xbf\xbd");
}

TEST(Problem, HasItsStatusCodesPhrase) {
  const nlohmann::json document = to_json(make_problem(404, "no scene is called \"x\""));
  EXPECT_EQ(
      document,
      (nlohmann::json{
          {"type", "about:blank"}, {"title", "Not Found"}, {"status", 404}, {"detail", "no scene is called \"x\""}}));
}

TEST(Edits, AsManyAsAllowedAndNoMore) {
  nlohmann::json patch{{"edits", nlohmann::json::array()}};
  for (int i = 0; i < 4096; ++i) patch["edits"].push_back({{"op", "remove"}, {"path", "/nodes/0"}});
  EXPECT_TRUE(parse_session_patch(patch.dump()).ok());
  patch["edits"].push_back({{"op", "remove"}, {"path", "/nodes/0"}});
  const Decoded<SessionPatch> parsed = parse_session_patch(patch.dump());
  ASSERT_FALSE(parsed.ok());
  EXPECT_EQ(parsed.problem().pointer, "/edits");
}

TEST(Edits, MembersThatRfc6902DoesNotDefineAreIgnored) {
  EXPECT_TRUE(parse_session_patch(R"({"edits":[{"op":"add","path":"/nodes/-","value":null,"xyz":123}]})").ok());
}

TEST(Names, ReadBackAsWritten) {
  for (const ImageFormat format : {ImageFormat::kPng, ImageFormat::kJpeg, ImageFormat::kExr})
    EXPECT_EQ(image_format_from_name(name_of(format)), format);
  for (const Role role : {Role::kDriver, Role::kViewer}) EXPECT_EQ(role_from_name(name_of(role)), role);
  EXPECT_FALSE(image_format_from_name("PNG"));
  EXPECT_FALSE(role_from_name(""));
}

TEST(Names, OfScenes) {
  EXPECT_TRUE(is_scene_name("a"));
  EXPECT_TRUE(is_scene_name(std::string(64, '_')));
  EXPECT_FALSE(is_scene_name(std::string(65, 'a')));
  EXPECT_FALSE(is_scene_name(""));
  EXPECT_FALSE(is_scene_name("a.b"));
  EXPECT_FALSE(is_scene_name(std::string_view("a\0b", 3)));
}

}  // namespace
}  // namespace lightwell::protocol
