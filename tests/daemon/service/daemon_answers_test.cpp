#include "daemon/service/daemon_answers.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <string>
#include <thread>

#include "daemon/socket/listener.h"
#include "tests/daemon/temporary_folder.h"

namespace softgrip::daemon::daemon_answers_test {
namespace {

/// A server that accepts one client, reads its request, replies with a text and closes the connection.
class Replying {
 public:
  Replying(const std::string& path, const std::string& reply) : listener_(open(path)), reply_(reply) {
    thread_ = std::thread([this] { serve(); });
  }
  ~Replying() { thread_.join(); }
  Replying(const Replying&) = delete;
  Replying& operator=(const Replying&) = delete;
  Replying(Replying&&) = delete;
  Replying& operator=(Replying&&) = delete;

 private:
  static Listener open(const std::string& path) {
    rig::SocketFile file;
    file.path = path;
    return std::move(*Listener::open(file));
  }
  void serve() {
    pollfd waiting{listener_.socket().get(), POLLIN, 0};
    EXPECT_EQ(::poll(&waiting, 1, 10'000), 1);
    const Descriptor client(::accept(listener_.socket().get(), nullptr, nullptr));
    std::array<char, 1000> text{};
    const ssize_t count = ::read(client.get(), text.data(), text.size());
    EXPECT_NE(std::string(text.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0))).find("status"),
              std::string::npos);
    EXPECT_EQ(::send(client.get(), reply_.data(), reply_.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(reply_.size()));
  }

  Listener listener_;
  std::string reply_;
  std::thread thread_;
};

class DaemonAnswers : public ::testing::Test {
 protected:
  [[nodiscard]] bool with_reply(const std::string& reply) const {
    const Replying program(path_, reply);
    return daemon_answers(path_);
  }
  testing::TemporaryFolder folder_;
  std::string path_ = folder_.path() + "/socket";
};

TEST_F(DaemonAnswers, AReplyOfTheSocketApi) {
  EXPECT_TRUE(with_reply("{\"ok\": true, \"result\": {}}\n"));
  EXPECT_TRUE(with_reply("{\"ok\": false, \"error\": {\"code\": \"busy\"}}\nmore"));
}

TEST_F(DaemonAnswers, AnotherProgramIsNoDaemon) {
  EXPECT_FALSE(with_reply("HTTP/1.1 400 Bad Request\r\n"));
  EXPECT_FALSE(with_reply("{}\n"));
  EXPECT_FALSE(with_reply("[\"ok\"]\n"));
  EXPECT_FALSE(with_reply("{\"ok\": tr")) << "the connection ended after half a line";
}

TEST_F(DaemonAnswers, WhoAcceptsAndStaysSilentIsNoDaemon) {
  rig::SocketFile file;
  file.path = path_;
  const auto listener = Listener::open(file);  // this listener accepts no connection, but the kernel does
  ASSERT_TRUE(listener);
  EXPECT_FALSE(daemon_answers(path_));
}

TEST_F(DaemonAnswers, NobodyIsNoDaemon) {
  EXPECT_FALSE(daemon_answers(path_));
  EXPECT_FALSE(daemon_answers(""));
  EXPECT_FALSE(daemon_answers(std::string(200, 'x')));
}

}  // namespace
}  // namespace softgrip::daemon::daemon_answers_test
