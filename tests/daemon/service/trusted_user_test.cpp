#include "daemon/service/trusted_user.h"

#include <grp.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <thread>

#include "base/descriptor.h"
#include "base/files.h"
#include "daemon/socket/listener.h"

namespace softgrip::daemon::trusted_user_test {
namespace {

constexpr uid_t nobody = 65534;

TEST(TrustedUser, OnlyRootAndThisUserAreTrusted) {
  EXPECT_TRUE(is_trusted(0));
  EXPECT_TRUE(is_trusted(::geteuid()));
  EXPECT_FALSE(is_trusted(nobody));
  EXPECT_FALSE(is_trusted(4'000'000'000U));
}

/// Connects to this process as `user`. Returns the credentials that the kernel reports for this peer.
std::optional<Peer> peer_as(uid_t user) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::snprintf(address.sun_path + 1, sizeof address.sun_path - 1, "softgrip-test-peer-%d", ::getpid());
  const auto* const generic = reinterpret_cast<const sockaddr*>(&address);
  const Descriptor listening(::socket(AF_UNIX, SOCK_STREAM, 0));
  EXPECT_EQ(::bind(listening.get(), generic, sizeof address), 0);
  EXPECT_EQ(::listen(listening.get(), 1), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const Descriptor socket(::socket(AF_UNIX, SOCK_STREAM, 0));
    const bool other =
        user == ::geteuid() || (::setgroups(0, nullptr) == 0 && ::setresgid(user, user, user) == 0 &&
                                ::setresuid(user, user, user) == 0);
    const bool connected = other && ::connect(socket.get(), generic, sizeof address) == 0;
    ::_exit(connected ? 0 : 1);
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  const Descriptor accepted(::accept(listening.get(), nullptr, nullptr));
  auto peer = peer_of(accepted.get());
  EXPECT_TRUE(peer && peer->process == child);
  return peer;
}

TEST(TrustedUser, APeerOfThisUserIsTrusted) {
  const auto peer = peer_as(::geteuid());
  ASSERT_TRUE(peer);
  EXPECT_EQ(peer->user, ::geteuid());
  EXPECT_TRUE(peer->trusted);
}

TEST(TrustedUser, APeerOfAnotherUserIsNotTrusted) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can run this test as another user";
  const auto peer = peer_as(nobody);
  ASSERT_TRUE(peer);
  EXPECT_EQ(peer->user, nobody);
  EXPECT_FALSE(peer->trusted);
}

TEST(TrustedUser, AnInvalidDescriptorHasNoPeer) {
  EXPECT_FALSE(peer_of(-1));
}

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
  ScratchFolder folder_;
  std::string path_ = folder_.path() + "/socket";
};

TEST_F(DaemonAnswers, AReplyOfTheSocketApiIsRecognised) {
  EXPECT_TRUE(with_reply("{\"ok\": true, \"result\": {}}\n"));
  EXPECT_TRUE(with_reply("{\"ok\": false, \"error\": {\"code\": \"busy\"}}\nmore"));
}

TEST_F(DaemonAnswers, RepliesOfAnotherProgramAreNotRecognised) {
  EXPECT_FALSE(with_reply("HTTP/1.1 400 Bad Request\r\n"));
  EXPECT_FALSE(with_reply("{}\n"));
  EXPECT_FALSE(with_reply("[\"ok\"]\n"));
  EXPECT_FALSE(with_reply("{\"ok\": tr")) << "the connection ended after half a line";
}

TEST_F(DaemonAnswers, ASilentListenerIsNotRecognised) {
  rig::SocketFile file;
  file.path = path_;
  const auto listener = Listener::open(file);  // this listener accepts no connection, but the kernel does
  ASSERT_TRUE(listener);
  EXPECT_FALSE(daemon_answers(path_));
}

TEST_F(DaemonAnswers, AMissingSocketIsNotRecognised) {
  EXPECT_FALSE(daemon_answers(path_));
  EXPECT_FALSE(daemon_answers(""));
  EXPECT_FALSE(daemon_answers(std::string(200, 'x')));
}

}  // namespace
}  // namespace softgrip::daemon::trusted_user_test
