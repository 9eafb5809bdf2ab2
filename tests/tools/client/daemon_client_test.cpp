#include "tools/client/daemon_client.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "base/files.h"
#include "base/net/listener.h"

namespace softgrip::tools::daemon_client_test {
namespace {

using Json = nlohmann::ordered_json;

/// A server that accepts one client and waits for one line. It then sends the given reply and closes the
/// connection.
class ScriptedDaemon {
 public:
  explicit ScriptedDaemon(std::string reply) : reply_(std::move(reply)) {
    listener_ = std::move(*net::listen_unix(path()));
    thread_ = std::thread([this] { serve(); });
  }
  ScriptedDaemon(const ScriptedDaemon&) = delete;
  ScriptedDaemon& operator=(const ScriptedDaemon&) = delete;
  ScriptedDaemon(ScriptedDaemon&&) = delete;
  ScriptedDaemon& operator=(ScriptedDaemon&&) = delete;
  ~ScriptedDaemon() { thread_.join(); }

  [[nodiscard]] std::string path() const { return folder_.path() + "/daemon.sock"; }

 private:
  void serve() {
    Descriptor client;
    while (!client) {
      client = net::accept_client(listener_);
      if (!client) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    char byte = 0;
    while (byte != '\n') {
      if (::recv(client.get(), &byte, 1, 0) < 1) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    for (const char out : reply_)
      ::send(client.get(), &out, 1, MSG_NOSIGNAL);  // send each byte with a
                                                    // separate call
  }

  const ScratchFolder folder_;
  std::string reply_;
  Descriptor listener_;
  std::thread thread_;
};

tl::expected<Json, ClientFailure> answer_to(const std::string& reply) {
  const ScriptedDaemon daemon(reply);
  auto client = DaemonClient::connect(daemon.path());
  EXPECT_TRUE(client);
  return client->call({{"command", "status"}});
}

TEST(DaemonClient, ReturnsTheResultOfASuccessfulReply) {
  const auto result = answer_to("{\"id\": null, \"ok\": true, \"result\": {\"state\": \"idle\"}}\n");
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ((*result)["state"], "idle");
}

class HangingDaemon : public ::testing::Test {
 protected:
  HangingDaemon() : listener_(std::move(*net::listen_unix(path_))) {}

  const ScratchFolder folder_;
  std::string path_ = folder_.path() + "/daemon.sock";
  Descriptor listener_;
};

TEST_F(HangingDaemon, DoesNotBlockAClientThatSendsRequests) {
  auto client = DaemonClient::connect_without_waiting(path_);
  ASSERT_TRUE(client);
  const Json request{{"command", std::string(10'000, 'x')}};
  tl::expected<std::optional<Json>, ClientFailure> line = std::optional<Json>{};
  int sent = 0;
  for (; line && sent < 1000; ++sent) {
    client->send(request);
    line = client->next_line(std::chrono::milliseconds(0));
  }
  ASSERT_FALSE(line) << "after " << sent << " requests";
  EXPECT_NE(line.error().message.find("does not accept requests"), std::string::npos) << line.error().message;
  client->send(request);
  EXPECT_FALSE(client->next_line(std::chrono::milliseconds(0)));
}

TEST(DaemonClient, ErrorStatesHowToProceedIfNoDaemonListens) {
  const auto absent = DaemonClient::connect("/tmp/no/such.sock");
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, ExitCode::io);
  EXPECT_NE(absent.error().message.find("softgripd --config"), std::string::npos);

  const ScratchFolder folder;
  const std::string path = folder.path() + "/left.sock";
  { const auto listener = net::listen_unix(path); }
  const auto left_over = DaemonClient::connect(path);
  ASSERT_FALSE(left_over);
  EXPECT_NE(left_over.error().message.find("no process listens"), std::string::npos);
}

TEST(DaemonClient, ConnectAtOnceFailsIfTheConnectionQueueIsFull) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/full.sock";
  const auto listener = net::listen_unix(path);
  ASSERT_TRUE(listener);
  std::vector<DaemonClient> waiting;
  auto client = DaemonClient::connect_without_waiting(path);
  for (; client && waiting.size() < 10'000; client = DaemonClient::connect_without_waiting(path))
    waiting.push_back(std::move(*client));
  ASSERT_FALSE(client);
  EXPECT_EQ(client.error().code, ExitCode::io);
  EXPECT_NE(client.error().message.find("accepts no connection"), std::string::npos);
  EXPECT_FALSE(client.error().no_listener);
}

TEST(DaemonClient, MapsRefusalsToExitCodes) {
  const auto refused = answer_to(
      R"({"id":null,"ok":false,"error":{"code":"refused","message":"faulted","refusal":{"code":"R01","name":"faulted"}}})"
      "\n");
  EXPECT_EQ(refused.error().code, ExitCode::state_refused);
  EXPECT_NE(refused.error().message.find("R01"), std::string::npos);
  const auto sequence = answer_to(
      R"({"id":null,"ok":false,"error":{"code":"sequence_refused","message":"no","problems":[{"file":"a.yaml","line":3,"column":5,"message":"m","hint":"h"}]}})"
      "\n");
  EXPECT_EQ(sequence.error().code, ExitCode::input_refused);
  EXPECT_NE(sequence.error().message.find("a.yaml:3:5: m (h)"), std::string::npos);
}

TEST(DaemonClient, ALineThatIsTooLongIsARefusedInput) {
  const auto refused = answer_to(R"({"id":null,"ok":false,"error":{"code":"too_long","message":"m"}})"
                                 "\n");
  EXPECT_EQ(refused.error().code, ExitCode::input_refused);
}

TEST(DaemonClient, AMessageOfTheDaemonContainsNoControlCharacter) {
  const auto owned = answer_to(
      R"({"id":null,"ok":false,"error":{"code":"owned","message":"'\u009b31m\u001b[0m' has started"}})"
      "\n");
  EXPECT_EQ(owned.error().message, R"('\xc2\x9b31m\x1b[0m' has started)");
  const auto sequence = answer_to(
      R"({"id":null,"ok":false,"error":{"code":"sequence_refused","message":"no","problems":[{"file":"a\u009b.yaml","line":3,"column":5,"message":"m\u001b","hint":""}]}})"
      "\n");
  EXPECT_EQ(sequence.error().message, "no\na\\xc2\\x9b.yaml:3:5: m\\x1b");
}

TEST(DaemonClient, ReportsMalformedAndIncompleteRepliesAsIoErrors) {
  for (const char* nonsense : {"hello\n", "[1]\n", "{}\n",
                               R"({"ok":1})"
                               "\n"}) {
    const auto answer = answer_to(nonsense);
    EXPECT_EQ(answer.error().code, ExitCode::io);
    EXPECT_TRUE(answer.error().message.starts_with("softgripd sent a malformed reply: ")) << nonsense;
  }
  EXPECT_EQ(answer_to("{\"ok\"").error().code, ExitCode::io);
  EXPECT_EQ(answer_to("").error().code, ExitCode::io);
}

using Json = nlohmann::ordered_json;

/// A listening socket in place of a daemon. The test accepts the connection and sends the lines of the
/// daemon.
struct SilentDaemon {
  ScratchFolder folder;
  std::string path = folder.path() + "/daemon.sock";
  Descriptor listener = std::move(*net::listen_unix(path));
};

TEST(DaemonLink, PassesAllLinesReceivedBeforeTheConnectionEnds) {
  const SilentDaemon daemon;
  DaemonLink link(daemon.path);
  EXPECT_EQ(link.descriptor(), -1);
  EXPECT_TRUE(link.connect(ns_per_s));
  EXPECT_FALSE(link.connect(ns_per_s)) << "the link is already connected";
  EXPECT_GE(link.descriptor(), 0);
  std::vector<Json> heard;
  const auto on_line = [&heard](Json& line) { heard.push_back(std::move(line)); };
  EXPECT_TRUE(link.receive_lines(on_line));
  Descriptor client = net::accept_client(daemon.listener);
  ASSERT_TRUE(client);
  const std::string lines = "{\"event\": {\"id\": 1}}\n{\"event\": {\"id\": 2}}\n";
  ASSERT_EQ(::send(client.get(), lines.data(), lines.size(), 0), static_cast<ssize_t>(lines.size()));
  EXPECT_TRUE(link.receive_lines(on_line));
  EXPECT_EQ(heard.size(), 2U);
  ASSERT_EQ(::send(client.get(), lines.data(), lines.size(), 0), static_cast<ssize_t>(lines.size()));
  client.reset();
  EXPECT_FALSE(link.receive_lines(on_line));
  EXPECT_EQ(heard.size(), 4U) << "lines that arrive before the end of the connection are passed";
  EXPECT_FALSE(link);
  EXPECT_EQ(link.descriptor(), -1);
}

TEST(DaemonLink, WaitsAQuarterSecondBetweenConnectionAttempts) {
  SilentDaemon daemon;
  DaemonLink link(daemon.path);
  daemon.listener = Descriptor();
  ::unlink(daemon.path.c_str());
  EXPECT_FALSE(link.connect(ns_per_s));
  daemon.listener = std::move(*net::listen_unix(daemon.path));
  EXPECT_FALSE(link.connect(ns_per_s + ns_per_s / 4 - 1))
      << "the pause of 250 ms after a failed attempt has not ended";
  EXPECT_FALSE(link.receive_lines([](Json&) {}));
  EXPECT_TRUE(link.connect(ns_per_s + ns_per_s / 4));
  link.disconnect();
  EXPECT_FALSE(link);
  EXPECT_FALSE(link.connect_now()) << "connect_now() does not wait for the end of the pause";
  EXPECT_TRUE(link);
}

}  // namespace
}  // namespace softgrip::tools::daemon_client_test
