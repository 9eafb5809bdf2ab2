#include "tools/client/daemon_link.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/net/listener.h"
#include "tests/daemon/temporary_folder.h"

namespace softgrip::tools::daemon_link_test {
namespace {

using Json = nlohmann::ordered_json;

/// A listening socket in place of a daemon. It sends nothing; a test sends the lines of the daemon itself.
struct SilentDaemon {
  daemon::testing::TemporaryFolder folder;
  std::string path = folder.path() + "/daemon.sock";
  Descriptor listener = std::move(*net::listen_unix(path));
};

TEST(DaemonLink, PassesLinesUntilTheConnectionEnds) {
  const SilentDaemon daemon;
  DaemonLink link(daemon.path);
  EXPECT_EQ(link.descriptor(), -1);
  EXPECT_TRUE(link.connect(ns_per_s));
  EXPECT_FALSE(link.connect(ns_per_s)) << "the link is connected";
  EXPECT_GE(link.descriptor(), 0);
  std::vector<Json> heard;
  const auto take = [&heard](Json& line) { heard.push_back(std::move(line)); };
  EXPECT_TRUE(link.hear(take));
  Descriptor client = net::accept_client(daemon.listener);
  ASSERT_TRUE(client);
  const std::string lines = "{\"event\": {\"id\": 1}}\n{\"event\": {\"id\": 2}}\n";
  ASSERT_EQ(::send(client.get(), lines.data(), lines.size(), 0), static_cast<ssize_t>(lines.size()));
  EXPECT_TRUE(link.hear(take));
  EXPECT_EQ(heard.size(), 2U);
  ASSERT_EQ(::send(client.get(), lines.data(), lines.size(), 0), static_cast<ssize_t>(lines.size()));
  client.reset();
  EXPECT_FALSE(link.hear(take));
  EXPECT_EQ(heard.size(), 4U) << "lines before the end are passed";
  EXPECT_FALSE(link);
  EXPECT_EQ(link.descriptor(), -1);
}

TEST(DaemonLink, PausesBetweenAttempts) {
  SilentDaemon daemon;
  DaemonLink link(daemon.path);
  daemon.listener = Descriptor();
  ::unlink(daemon.path.c_str());
  EXPECT_FALSE(link.connect(ns_per_s));
  daemon.listener = std::move(*net::listen_unix(daemon.path));
  EXPECT_FALSE(link.connect(ns_per_s + ns_per_s / 4 - 1)) << "250 ms have not passed";
  EXPECT_FALSE(link.hear([](Json&) {}));
  EXPECT_TRUE(link.connect(ns_per_s + ns_per_s / 4));
  link.end();
  EXPECT_FALSE(link);
  EXPECT_FALSE(link.connect_now()) << "connects without a pause";
  EXPECT_TRUE(link);
}

}  // namespace
}  // namespace softgrip::tools::daemon_link_test
