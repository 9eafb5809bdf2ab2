#include "daemon/socket/socket_server.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <optional>
#include <set>
#include <thread>

#include "base/clock.h"
#include "base/files.h"
#include "base/periodic_schedule.h"
#include "tests/support/files.h"

namespace softgrip::daemon::socket_server_test {
namespace {

Descriptor connect_to(const std::string& path) {
  Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path.data(), path.size());
  EXPECT_EQ(::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0)
      << std::strerror(errno);
  return socket;
}

class SocketServerTest : public ::testing::Test {
 protected:
  SocketServerTest() {
    settings_.path = temporary_.path() + "/socket";
    settings_.max_clients = 3;
    settings_.max_line_bytes = 100;
    settings_.max_queue_bytes = 300'000;
  }

  SocketServer& server() {
    if (!server_) {
      auto listening = SocketServer::listen(settings_);
      EXPECT_TRUE(listening) << listening.error();
      server_.emplace(std::move(*listening));
      server_->set_handlers({[this](std::uint64_t client, std::string_view line) {
                               lines_.emplace_back(line);
                               if (answer_) answer_(client, line);
                             },
                             [this](std::uint64_t) { ++closed_; },
                             [](std::string_view line) { return line.rfind("urgent", 0) == 0; },
                             [this](std::uint64_t, Role role) { opened_.push_back(role); },
                             [this](std::uint64_t client) { return protected_.contains(client); }});
    }
    return *server_;
  }
  /// Polls the server `cycles` times. Advances the time by `step` before each poll.
  void turn(int cycles = 5, Nanoseconds step = 0) {
    for (int i = 0; i < cycles; ++i) {
      now_ += step;
      server().poll(now_, now_ + 1'000'000);
    }
  }
  static void send_text(const Descriptor& socket, std::string_view text) {
    ASSERT_EQ(::send(socket.get(), text.data(), text.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(text.size()));
  }
  /// Returns the data that the client has received. Returns nullopt if the server has closed the connection.
  static std::optional<std::string> received(const Descriptor& socket) {
    std::string text(1 << 20, '\0');
    const ssize_t count = ::recv(socket.get(), text.data(), text.size(), 0);
    if (count == 0) return std::nullopt;
    text.resize(count < 0 ? 0 : static_cast<std::size_t>(count));
    return text;
  }

  ScratchFolder temporary_;
  rig::SocketSettings settings_;
  std::optional<SocketServer> server_;
  std::vector<std::string> lines_;
  std::function<void(std::uint64_t, std::string_view)> answer_;
  std::vector<Role> opened_;
  std::set<std::uint64_t> protected_;
  int closed_ = 0;
  Nanoseconds now_ = MonotonicClock().now();
};

TEST_F(SocketServerTest, TheSocketFileHasTheConfiguredMode) {
  settings_.mode = 0640;
  server();
  struct stat status {};
  ASSERT_EQ(stat(settings_.path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640U);
}

TEST_F(SocketServerTest, AMissingGroupIsAnError) {
  settings_.group = "no-such-group";
  const auto listening = SocketServer::listen(settings_);
  ASSERT_FALSE(listening);
  EXPECT_NE(listening.error().find("no-such-group"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(settings_.path));
}

TEST_F(SocketServerTest, RemovesTheSocketFileAndReplacesAStaleOne) {
  server();
  server_.reset();
  EXPECT_FALSE(std::filesystem::exists(settings_.path));
  {
    // Simulates a daemon that was killed and therefore did not remove its socket file.
    Descriptor socket(::socket(AF_UNIX, SOCK_STREAM, 0));
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, settings_.path.data(), settings_.path.size());
    ASSERT_EQ(bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  ASSERT_TRUE(std::filesystem::exists(settings_.path));
  server();
  const Descriptor client = connect_to(settings_.path);
}

TEST_F(SocketServerTest, ASecondDaemonIsRefusedAndTheFileRemains) {
  server();
  const auto second = SocketServer::listen(settings_);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().find("another softgripd"), std::string::npos);
  const Descriptor client = connect_to(settings_.path);
}

TEST_F(SocketServerTest, AFileThatIsNotASocketIsNotChanged) {
  { std::ofstream(settings_.path) << "precious"; }
  EXPECT_FALSE(SocketServer::listen(settings_));
  EXPECT_EQ(test::text_of(settings_.path), "precious");
}

TEST_F(SocketServerTest, FragmentedLinesAreReceivedComplete) {
  server();
  const Descriptor client = connect_to(settings_.path);
  turn();
  for (const char c : std::string("{\"a\":1}\r\nsecond\n\nthird")) {
    send_text(client, std::string_view(&c, 1));
    turn(1);
  }
  turn();
  EXPECT_EQ(lines_, (std::vector<std::string>{"{\"a\":1}", "second"}));
  send_text(client, "\n");
  turn();
  EXPECT_EQ(lines_.back(), "third");
}

TEST_F(SocketServerTest, ATooLongLineIsAnsweredAndClosesTheConnection) {
  server();
  const Descriptor client = connect_to(settings_.path);
  turn();
  send_text(client, "short\n" + std::string(101, 'x') + "\nafter\n");
  turn();
  EXPECT_EQ(lines_, std::vector<std::string>{"short"});
  EXPECT_NE(received(client).value_or("").find("too_long"), std::string::npos);
  EXPECT_FALSE(received(client).has_value());
  EXPECT_EQ(closed_, 1);
}

TEST_F(SocketServerTest, AnUnterminatedLongLineClosesTheConnection) {
  server();
  const Descriptor client = connect_to(settings_.path);
  turn();
  send_text(client, std::string(10'000, 'x'));
  turn();
  EXPECT_NE(received(client).value_or("").find("too_long"), std::string::npos);
  EXPECT_EQ(server().clients(), 0U);
}

TEST_F(SocketServerTest, AnExcessClientIsRefusedAndTheOthersStay) {
  server();
  std::vector<Descriptor> clients;
  for (int i = 0; i < 4; ++i) clients.push_back(connect_to(settings_.path));
  turn();
  send_text(clients[3], "and I\n");
  turn();
  EXPECT_NE(received(clients[3]).value_or("").find("too_many_clients"), std::string::npos);
  EXPECT_FALSE(received(clients[3]));
  EXPECT_EQ(server().clients(), 3U);
  send_text(clients[0], "still here\n");
  turn();
  EXPECT_EQ(lines_, std::vector<std::string>{"still here"});
}

TEST_F(SocketServerTest, AnUrgentLineIsAcceptedAtTheClientLimit) {
  answer_ = [this](std::uint64_t client, std::string_view) { server().send(client, "done\n", false); };
  server();
  std::vector<Descriptor> clients;
  for (int i = 0; i < 3; ++i) {
    clients.push_back(connect_to(settings_.path));
    send_text(clients.back(), "hello\n");
  }
  turn();
  lines_.clear();
  const Descriptor late = connect_to(settings_.path);
  send_text(late, "urgent: down\nand more\n");
  turn(1);
  turn(1);
  EXPECT_EQ(lines_, std::vector<std::string>{"urgent: down"});
  EXPECT_EQ(received(late), "done\n");
  turn(2, 3 * ns_per_s);
  EXPECT_FALSE(received(late)) << "the server closes the connection without a further message";
}

TEST_F(SocketServerTest, TheLongestSilentClientIsDisconnectedFirst) {
  server();
  std::vector<Descriptor> clients;
  for (int i = 0; i < 3; ++i) {
    clients.push_back(connect_to(settings_.path));
    if (i != 1) send_text(clients.back(), "hello\n");
    turn(1, ns_per_s / 100);
    turn(1, ns_per_s / 100);
  }
  turn(1, ns_per_s);
  clients.push_back(connect_to(settings_.path));
  turn();
  EXPECT_NE(received(clients[1]).value_or("").find("too_many_clients"), std::string::npos)
      << "the client that never sent a line is disconnected first";
  turn(1, 6 * ns_per_s);
  send_text(clients[3], "hello\n");
  turn();
  clients.push_back(connect_to(settings_.path));
  turn();
  EXPECT_NE(received(clients[0]).value_or("").find("too_many_clients"), std::string::npos)
      << "the client that sent nothing for the longest time is disconnected";
  EXPECT_EQ(received(clients[2]), "");
  EXPECT_EQ(received(clients[3]), "");
}

TEST_F(SocketServerTest, AProtectedClientIsNeverDisplaced) {
  protected_ = {1, 3};
  server();
  std::vector<Descriptor> clients;
  for (int i = 0; i < 3; ++i) {
    clients.push_back(connect_to(settings_.path));
    send_text(clients.back(), "hello\n");
    turn();
  }
  turn(1, 60 * ns_per_s);
  clients.push_back(connect_to(settings_.path));
  send_text(clients.back(), "hello\n");
  turn();
  EXPECT_NE(received(clients[1]).value_or("").find("too_many_clients"), std::string::npos)
      << "a silent client that does not receive events is disconnected";
  protected_.insert(4);
  turn(1, 60 * ns_per_s);
  const Descriptor late = connect_to(settings_.path);
  send_text(late, "and I\n");
  turn();
  EXPECT_NE(received(late).value_or("").find("too_many_clients"), std::string::npos)
      << "the largest number of clients is connected, so the new client is refused with a message";
  for (const std::size_t i : {0UL, 2UL, 3UL})
    EXPECT_EQ(received(clients[i]), "") << i << " is still connected";
  const Descriptor urgent = connect_to(settings_.path);
  lines_.clear();
  send_text(urgent, "urgent: down\n");
  turn(2);
  EXPECT_EQ(lines_, std::vector<std::string>{"urgent: down"});
}

TEST_F(SocketServerTest, ReadOnlyClientsHaveASeparateClientLimit) {
  settings_.look.path = temporary_.path() + "/look";
  settings_.look.mode = 0666;
  server();
  std::vector<Descriptor> viewers;
  for (int i = 0; i < 3; ++i) {
    viewers.push_back(connect_to(settings_.look.path));
    send_text(viewers.back(), "hello\n");
    turn();
  }
  const Descriptor operating = connect_to(settings_.path);
  send_text(operating, "move\n");
  turn();
  EXPECT_EQ(received(operating), "") << "this client remains connected";
  EXPECT_EQ(opened_, (std::vector<Role>{Role::look, Role::look, Role::look, Role::operate}));
  const Descriptor late = connect_to(settings_.look.path);
  send_text(late, "and I\n");
  turn();
  EXPECT_NE(received(late).value_or("").find("too_many_clients"), std::string::npos);
  EXPECT_EQ(received(operating), "");
  struct stat status {};
  ASSERT_EQ(stat(settings_.look.path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0666U);
  server_.reset();
  EXPECT_NE(stat(settings_.look.path.c_str(), &status), 0) << "the read-only socket file is also removed";
}

TEST_F(SocketServerTest, OperatorsAreServedBeforeReadOnlyClients) {
  settings_.look.path = temporary_.path() + "/look";
  server();
  const Descriptor viewer = connect_to(settings_.look.path);
  turn();
  const Descriptor operating = connect_to(settings_.path);
  turn();
  send_text(viewer, "first\n");
  send_text(operating, "second\n");
  turn(1);
  EXPECT_EQ(lines_, (std::vector<std::string>{"second", "first"}));
}

TEST_F(SocketServerTest, ManyClientsDoNotBlockAnUrgentLine) {
  server();
  std::vector<Descriptor> excess_clients;
  for (int i = 0; i < 300; ++i) {
    excess_clients.push_back(connect_to(settings_.path));
    if (i % 3 != 0) send_text(excess_clients.back(), "noise\nnoise\nnoise\n");
    turn(1);
  }
  lines_.clear();
  const Descriptor late = connect_to(settings_.path);
  send_text(late, "urgent: down\n");
  turn(2);
  EXPECT_NE(std::find(lines_.begin(), lines_.end(), "urgent: down"), lines_.end());
}

TEST_F(SocketServerTest, AClientWithManyRequestsDoesNotBlockOthers) {
  answer_ = [](std::uint64_t, std::string_view line) {
    if (line == "slow") std::this_thread::sleep_for(std::chrono::milliseconds(5));
  };
  server();
  const Descriptor busy_client = connect_to(settings_.path);
  const Descriptor other = connect_to(settings_.path);
  std::string questions;
  for (int i = 0; i < 1000; ++i) questions += "slow\n";
  send_text(busy_client, questions);
  turn(2);
  send_text(other, "me\n");
  turn(2);
  EXPECT_NE(std::find(lines_.begin(), lines_.end(), "me"), lines_.end());
  EXPECT_LT(lines_.size(), 10U);
}

TEST_F(SocketServerTest, ASocketFileOfAnotherServerIsNotRemoved) {
  server();
  std::filesystem::remove(settings_.path);
  auto another = SocketServer::listen(settings_);
  ASSERT_TRUE(another);
  server_.reset();
  EXPECT_TRUE(std::filesystem::exists(settings_.path));
}

TEST_F(SocketServerTest, AReplyAboveTheQueueLimitDisconnectsTheClient) {
  answer_ = [this](std::uint64_t client, std::string_view) {
    server().send(client, std::string(400'000, 'a'), false);
  };
  server();
  const Descriptor client = connect_to(settings_.path);
  turn();
  send_text(client, "more\nmore\n");
  turn();
  EXPECT_EQ(server().clients(), 0U);
  EXPECT_EQ(lines_.size(), 1U);
}

TEST_F(SocketServerTest, AClientThatDoesNotReadIsPausedThenDisconnected) {
  answer_ = [this](std::uint64_t client, std::string_view) {
    server().send(client, std::string(50'000, 'a'), false);
  };
  server();
  const Descriptor client = connect_to(settings_.path);
  turn();
  for (int i = 0; i < 200; ++i) {
    send_text(client, "more\n");
    turn(1);
  }
  EXPECT_LT(lines_.size(), 100U) << "further requests of a client wait in the buffer of this client";
  EXPECT_EQ(server().clients(), 1U);
  turn(11, ns_per_s);
  EXPECT_EQ(server().clients(), 0U);
}

TEST_F(SocketServerTest, RequestsWaitUntilTheClientReadsTheReplies) {
  answer_ = [this](std::uint64_t client, std::string_view) {
    server().send(client, std::string(250'000, 'a'), false);
  };
  server();
  const Descriptor client = connect_to(settings_.path);
  turn();
  std::string questions;
  for (int i = 0; i < 100; ++i) questions += "more\n";
  send_text(client, questions);
  turn(50);
  EXPECT_EQ(server().clients(), 1U)
      << "most requests must wait, because the queue cannot hold all 100 replies";
  const std::size_t before = lines_.size();
  EXPECT_LT(before, 5U);
  for (int i = 0; i < 20; ++i) {
    (void)received(client);
    turn(1);
  }
  EXPECT_GT(lines_.size(), before);
}

TEST_F(SocketServerTest, ASlowWatcherMissesStatesAndIsDisconnected) {
  std::uint64_t watcher = 0;
  answer_ = [&](std::uint64_t client, std::string_view) { watcher = client; };
  server();
  const Descriptor client = connect_to(settings_.path);
  send_text(client, "watch\n");
  turn();
  for (int i = 0; i < 1000; ++i) server().send(watcher, std::string(10'000, 'w'), true);
  turn();
  EXPECT_EQ(server().clients(), 1U) << "states that a client has not read do not accumulate in its queue";
  turn(11, ns_per_s);
  EXPECT_EQ(server().clients(), 0U) << "the client has read nothing for 10 s";
}

TEST_F(SocketServerTest, ASlowClientThatKeepsReadingStaysConnected) {
  std::uint64_t watcher = 0;
  answer_ = [&](std::uint64_t client, std::string_view) { watcher = client; };
  server();
  const Descriptor client = connect_to(settings_.path);
  send_text(client, "watch\n");
  turn();
  for (int second = 0; second < 30; ++second) {
    server().send(watcher, std::string(10'000, 'w') + "\n", true);
    turn(1, ns_per_s);
    ASSERT_TRUE(received(client).has_value());
  }
  EXPECT_EQ(server().clients(), 1U);
}

TEST_F(SocketServerTest, AHalfClosedConnectionStillReceivesTheReply) {
  std::uint64_t asker = 0;
  answer_ = [&](std::uint64_t client, std::string_view) { asker = client; };
  server();
  const Descriptor client = connect_to(settings_.path);
  send_text(client, "ask\n");
  shutdown(client.get(), SHUT_WR);
  turn();
  server().send(asker, "answer\n", false);
  turn();
  EXPECT_EQ(received(client), "answer\n");
  turn(4, ns_per_s);
  EXPECT_EQ(server().clients(), 0U);
}

TEST_F(SocketServerTest, AnUrgentLineOfADisconnectedClientIsProcessed) {
  std::uint64_t sender = 0;
  answer_ = [&](std::uint64_t client, std::string_view) { sender = client; };
  server();
  for (const std::size_t unread : {0U, 10U, 250'000U}) {
    SCOPED_TRACE(unread);
    {
      const Descriptor client = connect_to(settings_.path);
      send_text(client, "hello\n");
      turn();
      if (unread > 0) server().send(sender, std::string(unread, 'a'), false);
      // The client sends these lines and disconnects. The server does not run meanwhile, as if its process
      // were paused.
      send_text(client, "move\nurgent: down\nmove\n");
      lines_.clear();
    }
    turn(20);
    EXPECT_EQ(std::count(lines_.begin(), lines_.end(), "urgent: down"), 1);
    EXPECT_EQ(std::count(lines_.begin(), lines_.end(), "move"), 0)
        << "a request of a client that has disconnected must not cause motion";
    EXPECT_EQ(server().clients(), 0U);
  }
  EXPECT_EQ(closed_, 3);
}

TEST_F(SocketServerTest, ADisconnectedClientIsRemoved) {
  answer_ = [this](std::uint64_t client, std::string_view) { server().send(client, "answer\n", false); };
  server();
  {
    const Descriptor client = connect_to(settings_.path);
    send_text(client, "ask\n");
  }
  turn();
  EXPECT_EQ(server().clients(), 0U);
  EXPECT_EQ(closed_, 1);
}

}  // namespace
}  // namespace softgrip::daemon::socket_server_test
