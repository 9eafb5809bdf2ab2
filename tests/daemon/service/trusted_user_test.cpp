#include "daemon/service/trusted_user.h"

#include <grp.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>

#include "base/descriptor.h"

namespace softgrip::daemon::trusted_user_test {
namespace {

constexpr uid_t nobody = 65534;

TEST(TrustedUser, RootAndThisUserAreTrustedAndNobodyElse) {
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

TEST(TrustedUser, APeerOfThisUserCounts) {
  const auto peer = peer_as(::geteuid());
  ASSERT_TRUE(peer);
  EXPECT_EQ(peer->user, ::geteuid());
  EXPECT_TRUE(peer->trusted);
}

TEST(TrustedUser, APeerOfAnotherUserDoesNotCount) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root can run this test as another user";
  const auto peer = peer_as(nobody);
  ASSERT_TRUE(peer);
  EXPECT_EQ(peer->user, nobody);
  EXPECT_FALSE(peer->trusted);
}

TEST(TrustedUser, WhatIsNoSocketHasNoPeer) {
  EXPECT_FALSE(peer_of(-1));
}

}  // namespace
}  // namespace softgrip::daemon::trusted_user_test
