#include "studies/live/access.h"

#include <gtest/gtest.h>

#include <set>

using namespace fingertip::studies;

namespace {

const Access guard(8123, "0123456789abcdef");
constexpr const char* here = "127.0.0.1:8123";
constexpr const char* page = "http://127.0.0.1:8123";
constexpr const char* good = "token=0123456789abcdef";

}  // namespace

TEST(Access, TokensAreLongAndNeverTheSame) {
  std::set<std::string> tokens;
  for (int i = 0; i < 100; ++i) tokens.insert(random_token());
  EXPECT_EQ(tokens.size(), 100u);
  for (const std::string& token : tokens) {
    EXPECT_EQ(token.size(), 32u);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
  }
}

TEST(Access, KnowsItsOwnNamesOnly) {
  for (const char* host : {"127.0.0.1:8123", "localhost:8123", "localhost"})
    EXPECT_TRUE(guard.is_here(host));
  for (const char* host : {"", ":8123", "127.0.0.1:8124", "127.0.0.1:81233", "evil.example:8123",
                           "localhost:8123.evil.example", "127.0.0.1:8123 "})
    EXPECT_FALSE(guard.is_here(host)) << host;
  EXPECT_TRUE(guard.is_own_page("http://127.0.0.1:8123"));
  EXPECT_TRUE(guard.is_own_page("http://localhost:8123"));
  for (const char* origin : {"", "null", "https://127.0.0.1:8123", "http://127.0.0.1:8123/",
                             "http://evil.example", "http://127.0.0.1", "127.0.0.1:8123"})
    EXPECT_FALSE(guard.is_own_page(origin)) << origin;
}

TEST(Access, TakesTheTokenFromQueryOrCookie) {
  EXPECT_TRUE(guard.knows_token(good, ""));
  EXPECT_TRUE(guard.knows_token("a=b&token=0123456789abcdef", ""));
  EXPECT_TRUE(guard.knows_token("", "x=y; fingertip_8123=0123456789abcdef; z"));
  for (const char* query : {"", "token=", "token=0123456789abcdeg", "token=0123456789abcdef0",
                            "nottoken=0123456789abcdef", "token 0123456789abcdef"})
    EXPECT_FALSE(guard.knows_token(query, "")) << query;
  EXPECT_FALSE(guard.knows_token("", "fingertip_8124=0123456789abcdef"));
}

TEST(Access, PagesMayBeTypedButWebsocketsMustComeFromOwnPages) {
  EXPECT_TRUE(guard.may_read({here, "", "", good}));
  EXPECT_TRUE(guard.may_read({here, page, "", good}));
  EXPECT_FALSE(guard.may_read({here, "http://evil.example", "", good}));
  EXPECT_FALSE(guard.may_read({"evil.example:8123", "", "", good}));
  EXPECT_FALSE(guard.may_read({here, "", "", ""}));
  EXPECT_TRUE(guard.may_connect({here, page, "", good}));
  EXPECT_FALSE(guard.may_connect({here, "", "", good}));
  EXPECT_FALSE(guard.may_connect({here, "null", "", good}));
  EXPECT_FALSE(guard.may_connect({here, "http://evil.example", "", good}));
  EXPECT_FALSE(guard.may_connect({here, page, "", "token=1"}));
}

TEST(Access, RateLimitPassesABurstThenTheRate) {
  RateLimit limit(10.0, 5.0);
  int passed = 0;
  for (int i = 0; i < 20; ++i) passed += limit.pass(100.0);
  EXPECT_EQ(passed, 5);
  EXPECT_TRUE(limit.pass(100.11));
  EXPECT_FALSE(limit.pass(100.12));
  passed = 0;
  for (int i = 0; i < 1000; ++i) passed += limit.pass(101.0 + 0.01 * i);
  EXPECT_NEAR(passed, 5 + 100, 2);
}
