// Tokens, rates, hosts and origins as rules, without a server.
#include "server/access/access_control.h"

#include <gtest/gtest.h>

namespace lightwell {
namespace {

using std::chrono::milliseconds;

constexpr const char* kViewToken = "view-token-0123456789";
constexpr const char* kDriveToken = "drive-token-0123456789";

net::RequestHead head_of(std::vector<net::HeaderField> fields, const std::string& method = "POST") {
  net::RequestHead head;
  head.method = method;
  head.path = "/";
  head.fields = std::move(fields);
  return head;
}

TEST(Scopes, BringTheNarrowerOnesAlong) {
  EXPECT_TRUE(Scopes(Scope::kAdmin).has(Scope::kUpload));
  EXPECT_TRUE(Scopes(Scope::kDrive).has(Scope::kView));
  EXPECT_TRUE(Scopes(Scope::kUpload).has(Scope::kView));
  EXPECT_FALSE(Scopes(Scope::kDrive).has(Scope::kUpload));
  EXPECT_FALSE(Scopes(Scope::kView).has(Scope::kDrive));
  EXPECT_TRUE(Scopes().has(Scope::kPublic));
}

TEST(TokenList, ReadsLines) {
  const auto list =
      TokenList::parse("# who\nview view-token-0123456789\r\n\n  drive,upload \tdrive-token-0123456789\n");
  ASSERT_TRUE(list) << list.error().message();
  EXPECT_EQ(list->find(kViewToken), Scopes(Scope::kView));
  EXPECT_TRUE(list->find(kDriveToken).has(Scope::kUpload));
  for (const char* unknown : {"", "view-token-012345678", "view-token-01234567890", "View-token-0123456789"})
    EXPECT_TRUE(list->find(unknown).empty()) << unknown;
}

TEST(TokenList, NamesTheLineAndNeverTheToken) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "no token"},
      {"\n\nfly view-token-0123456789", "line 3: there is no scope \"fly\""},
      {"view short", "line 1: a token has 16 to 256 characters, not 5"},
      {"view", "line 1: a token has 16 to 256 characters, not 0"},
      {"view with a blank in it", "line 1: a token is of"},
      {"view view-token-0123456789\ndrive view-token-0123456789", "line 2: the token is given twice"}};
  for (const auto& [text, words] : cases) {
    const auto list = TokenList::parse(text);
    ASSERT_FALSE(list) << text;
    EXPECT_NE(list.error().message().find(words), std::string::npos) << list.error().message();
    EXPECT_EQ(list.error().message().find("0123456789"), std::string::npos);
  }
}

TEST(RateLimiter, LetsABurstThroughAndThenTheRate) {
  RateLimiter limiter(10.0, 3.0);
  const RateLimiter::Time start{};
  for (int i = 0; i < 3; ++i) EXPECT_EQ(limiter.take("a", start), 0.0);
  EXPECT_NEAR(limiter.take("a", start), 0.1, 1e-9);
  EXPECT_EQ(limiter.take("b", start), 0.0);
  EXPECT_GT(limiter.take("a", start + milliseconds(90)), 0.0);
  EXPECT_EQ(limiter.take("a", start + milliseconds(101)), 0.0);
  EXPECT_GT(limiter.take("a", start + milliseconds(102)), 0.0);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(limiter.take("a", start + milliseconds(5000)), 0.0);
  EXPECT_GT(limiter.take("a", start + milliseconds(5000)), 0.0);
}

TEST(RateLimiter, RemembersNoMoreClientsThanItCan) {
  RateLimiter limiter(1.0, 2.0);
  for (int i = 0; i < 200'000; ++i) EXPECT_EQ(limiter.take(std::to_string(i), {}), 0.0);
}

TEST(BearerToken, IsFoundWhereBrowsersAndOthersPutIt) {
  EXPECT_EQ(bearer_token(head_of({{"authorization", "Bearer abc"}})), "abc");
  EXPECT_EQ(bearer_token(head_of({{"authorization", "bearer   abc"}})), "abc");
  EXPECT_EQ(bearer_token(head_of({{"authorization", "Basic abc"}})), "");
  EXPECT_EQ(bearer_token(head_of({{"authorization", "Bearer"}})), "");
  auto stream = head_of({{"sec-websocket-protocol", "lightwell.v1, bearer.abc"}}, "GET");
  EXPECT_EQ(bearer_token(stream), "");
  stream.wants_web_socket = true;
  EXPECT_EQ(bearer_token(stream), "abc");
  stream.fields[0].value = "bearer.abc,lightwell.v1";
  EXPECT_EQ(bearer_token(stream), "abc");
  stream.fields[0].value = "notbearer.abc";
  EXPECT_EQ(bearer_token(stream), "");
}

int status_of(const std::optional<net::Refusal>& refusal) {
  return refusal ? refusal->status : 200;
}

TEST(Hosts, ANameThatLeadsHereFromElsewhereIsRefused) {
  AccessOptions options;
  options.allowed_hosts = {"render.example"};
  AccessControl access(options);
  for (const char* good : {"localhost", "LocalHost:8080", "127.0.0.1:1", "[::1]:8080", "render.example:443", ""})
    EXPECT_EQ(status_of(access.check_origin_and_rate(head_of({{"host", good}}), {})), 200) << good;
  for (const char* bad : {"evil.example", "localhost.evil.example", "render.example.evil", "[::2]:1"})
    EXPECT_EQ(status_of(access.check_origin_and_rate(head_of({{"host", bad}}), {})), 421) << bad;
  ASSERT_TRUE(options.tokens.add(kViewToken, Scope::kView));
  AccessControl with_tokens(options);
  EXPECT_EQ(status_of(with_tokens.check_origin_and_rate(head_of({{"host", "any.example"}}), {})), 200);
}

TEST(Origins, OnlyItsOwnAndThoseOnTheList) {
  AccessOptions options;
  options.allowed_origins = {"https://good.example"};
  AccessControl access(options);
  const auto status = [&](const char* origin, const char* method, bool web_socket) {
    auto head = head_of({{"host", "localhost:8080"}, {"origin", origin}}, method);
    head.wants_web_socket = web_socket;
    return status_of(access.check_origin_and_rate(head, {}));
  };
  EXPECT_EQ(status("http://localhost:8080", "POST", false), 200);
  EXPECT_EQ(status("https://good.example", "POST", false), 200);
  EXPECT_EQ(status("https://good.example", "GET", true), 200);
  EXPECT_EQ(status("https://evil.example", "POST", false), 403);
  EXPECT_EQ(status("https://evil.example", "GET", true), 403);
  EXPECT_EQ(status("https://evil.example", "GET", false), 200);
  EXPECT_EQ(status("null", "POST", false), 403);
}

TEST(Rates, AreOfATokenOrElseOfAnAddress) {
  AccessOptions options;
  options.requests_per_second = 1e-3;
  options.request_burst = 2.0;
  ASSERT_TRUE(options.tokens.add(kViewToken, Scope::kView));
  AccessControl access(options);
  const auto status = [&](const char* authorization, const char* address) {
    return status_of(access.check_origin_and_rate(head_of({{"authorization", authorization}}), {address, 1}));
  };
  const std::string known = std::string("Bearer ") + kViewToken;
  EXPECT_EQ(status(known.c_str(), "1.1.1.1"), 200);
  EXPECT_EQ(status(known.c_str(), "2.2.2.2"), 200);
  EXPECT_EQ(status(known.c_str(), "3.3.3.3"), 429);
  EXPECT_EQ(status("Bearer guess-1", "3.3.3.3"), 200);
  EXPECT_EQ(status("Bearer guess-2", "3.3.3.3"), 200);
  EXPECT_EQ(status("Bearer guess-3", "3.3.3.3"), 429);
}

}  // namespace
}  // namespace lightwell
