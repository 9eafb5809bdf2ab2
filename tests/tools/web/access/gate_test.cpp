#include "tools/web/access/gate.h"

#include <gtest/gtest.h>

namespace softgrip::web::gate_test {
namespace {

const std::string look(24, 'a');
const std::string operate(24, 'b');

TEST(OwnHost, IsAnIpAddressLocalhostOrAConfiguredName) {
  const std::vector<std::string> names{"gripper.example.org"};
  for (const char* own : {"localhost", "LOCALHOST:8017", "127.0.0.1", "127.0.0.1:8017", "[::1]:8017", "[::1]",
                          "192.168.1.20:80", "gripper.example.org", "Gripper.Example.org:8017"})
    EXPECT_TRUE(is_own_host(own, names)) << own;
  for (const char* other :
       {"", "evil.example", "localhost.evil.example", "127.0.0.1.evil.example", "127.0.0.1:", "127.0.0.1:80a",
        "[::1", "[::1]x", "[evil]", "gripper.example.org:8017:1", "localhost:123456"})
    EXPECT_FALSE(is_own_host(other, names)) << other;
}

TEST(OwnOrigin, RequiresTheSameHostAndPort) {
  EXPECT_TRUE(is_own_origin("http://127.0.0.1:8017", "127.0.0.1:8017"));
  EXPECT_TRUE(is_own_origin("https://gripper", "GRIPPER"));
  for (const char* other : {"http://127.0.0.1:8018", "http://127.0.0.1", "null", "", "127.0.0.1:8017",
                            "ftp://127.0.0.1:8017", "http://127.0.0.1:8017/", "http://evil/127.0.0.1:8017"})
    EXPECT_FALSE(is_own_origin(other, "127.0.0.1:8017")) << other;
}

TEST(Headers, ReturnTheCookieAndTheBearerToken) {
  EXPECT_EQ(cookie_of("a=1; softgrip=xyz; b=2", "softgrip"), "xyz");
  EXPECT_EQ(cookie_of("softgrip=xyz", "softgrip"), "xyz");
  EXPECT_EQ(cookie_of("notsoftgrip=xyz; softgripx=1", "softgrip"), "");
  EXPECT_EQ(cookie_of("", "softgrip"), "");
  EXPECT_EQ(bearer_of("Bearer abc"), "abc");
  EXPECT_EQ(bearer_of("Basic abc"), "");
}

class GateTest : public ::testing::Test {
 protected:
  Gate gate(Role without_token) {
    settings_.without_token = without_token;
    settings_.session_idle_s = 10;
    settings_.session_s = 100;
    return Gate(settings_, *Tokens::parse("look " + look + "\noperate " + operate));
  }
  static Credentials page() { return {"localhost:8017", "http://localhost:8017", "same-origin", "", ""}; }
  static int status(const tl::expected<Role, Refusal>& said) { return said ? 0 : said.error().status; }

  Settings settings_;
};

TEST_F(GateTest, RefusesForeignOriginsAndUnknownHosts) {
  Gate gate = this->gate(Role::operate);
  Credentials forged = page();
  EXPECT_EQ(gate.authorize(forged, true, 0), Role::operate);
  forged.origin = "http://evil.example";
  EXPECT_EQ(status(gate.authorize(forged, true, 0)), 403);
  EXPECT_EQ(status(gate.authorize(forged, false, 0)), 403);
  forged = page();
  forged.fetch_site = "cross-site";
  EXPECT_EQ(status(gate.authorize(forged, true, 0)), 403);
  forged.origin.clear();
  EXPECT_EQ(gate.authorize(forged, false, 0), Role::operate) << "a link from another site may open the page";
  forged.fetch_site.clear();
  EXPECT_EQ(status(gate.authorize(forged, true, 0)), 403)
      << "a request that changes the state requires an Origin header";
  forged.host = "evil.example:8017";
  forged.origin = "http://evil.example:8017";
  EXPECT_EQ(status(gate.authorize(forged, false, 0)), 421)
      << "a request whose Host header names another host must be refused";
}

TEST_F(GateTest, ATokenInAHeaderNeedsNoOrigin) {
  Gate gate = this->gate(Role::none);
  Credentials collector{"localhost", "", "", "", "Bearer " + look};
  EXPECT_EQ(gate.authorize(collector, false, 0), Role::look);
  collector.authorization = "Bearer " + operate;
  EXPECT_EQ(gate.authorize(collector, true, 0), Role::operate);
  collector.authorization = "Bearer " + std::string(24, 'c');
  EXPECT_EQ(gate.authorize(collector, false, 0), Role::none);
}

TEST_F(GateTest, ASessionHasTheRoleOfItsTokenUntilItEnds) {
  Gate gate = this->gate(Role::none);
  EXPECT_EQ(gate.open("unknown", 0).error().status, 401);
  const std::string id = *gate.open(operate, 0);
  EXPECT_EQ(id.size(), 64U);
  EXPECT_NE(id, *gate.open(operate, 0));
  Credentials browser = page();
  EXPECT_EQ(gate.authorize(browser, true, 0), Role::none);
  browser.cookie = "softgrip=" + id;
  for (int s = 0; s < 100; s += 9) EXPECT_EQ(gate.authorize(browser, true, s * ns_per_s), Role::operate) << s;
  EXPECT_EQ(gate.authorize(browser, true, 101 * ns_per_s), Role::none)
      << "a session ends after its longest duration, even if it is in use";

  const std::string idle = *gate.open(look, 0);
  browser.cookie = "softgrip=" + idle;
  EXPECT_EQ(gate.authorize(browser, false, 9 * ns_per_s), Role::look);
  EXPECT_EQ(gate.authorize(browser, false, 20 * ns_per_s), Role::none);

  const std::string left = *gate.open(look, 0);
  browser.cookie = "softgrip=" + left;
  gate.close(browser.cookie);
  EXPECT_EQ(gate.authorize(browser, false, 0), Role::none);
}

TEST_F(GateTest, LogInsWithOneTokenEndNoSessionOfAnother) {
  Gate gate = this->gate(Role::none);
  Credentials operator_page = page();
  operator_page.cookie = "softgrip=" + *gate.open(operate, 0);
  Credentials first_viewer = page();
  first_viewer.cookie = "softgrip=" + *gate.open(look, 0);
  Credentials last_viewer = page();
  for (int i = 0; i < 1000; ++i) last_viewer.cookie = "softgrip=" + *gate.open(look, 1);
  EXPECT_EQ(gate.authorize(operator_page, true, 2), Role::operate);
  EXPECT_EQ(gate.authorize(last_viewer, false, 2), Role::look);
  EXPECT_EQ(gate.authorize(first_viewer, false, 2), Role::none)
      << "the number of sessions per token is limited";
}

}  // namespace
}  // namespace softgrip::web::gate_test
