#include "base/net/poll_set.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <thread>
#include <utility>

#include "base/descriptor.h"

namespace softgrip::net::poll_set_test {
namespace {

using Outcome = PollSet::Outcome;

std::pair<Descriptor, Descriptor> connected() {
  std::array<int, 2> ends{};
  EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()), 0);
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

TEST(PollSet, ReportsTheEventsOfEachDescriptor) {
  auto [quiet, quiet_peer] = connected();
  auto [readable, readable_peer] = connected();
  auto [closed, closed_peer] = connected();
  ASSERT_EQ(::write(readable_peer.get(), "x", 1), 1);
  closed_peer.reset();
  PollSet polled;
  const auto none = polled.add(-1);
  const auto idle = polled.add(quiet.get());
  const auto input = polled.add(readable.get());
  const auto output = polled.add(quiet.get(), true, true);
  const auto ended = polled.add(closed.get(), false);
  const auto ignored = polled.add(readable.get(), false);
  const auto invalid = polled.add(1'000'000);
  ASSERT_EQ(polled.wait(ns_per_s), Outcome::done);
  EXPECT_FALSE(polled[none]);
  EXPECT_FALSE(polled[idle]);
  EXPECT_TRUE(polled[input] && polled[input].input());
  EXPECT_FALSE(polled[input].output() || polled[input].hangup_or_error() || polled[input].invalid());
  EXPECT_TRUE(polled[output] && polled[output].output());
  EXPECT_FALSE(polled[output].input());
  EXPECT_TRUE(polled[ended] && polled[ended].hangup_or_error());
  EXPECT_FALSE(polled[ended].input());
  EXPECT_FALSE(polled[ignored]);
  EXPECT_TRUE(polled[invalid] && polled[invalid].invalid());
}

TEST(PollSet, TheWaitEndsAtTheTimeout) {
  auto [quiet, peer] = connected();
  PollSet polled;
  const auto entry = polled.add(quiet.get());
  EXPECT_EQ(polled.wait(0), Outcome::done);
  EXPECT_EQ(polled.wait(ns_per_s / 1000), Outcome::done);
  EXPECT_FALSE(polled[entry]);
}

TEST(PollSet, CanBeReusedAfterClear) {
  auto [first, first_peer] = connected();
  auto [second, second_peer] = connected();
  ASSERT_EQ(::write(first_peer.get(), "x", 1), 1);
  PollSet polled;
  const auto old = polled.add(first.get());
  ASSERT_EQ(polled.wait(0), Outcome::done);
  EXPECT_TRUE(polled[old]);
  EXPECT_FALSE(polled[PollSet::Entry()]) << "an entry without a descriptor";
  polled.clear();
  ASSERT_EQ(polled.wait(0), Outcome::done);
  EXPECT_FALSE(polled[old]) << "the set is empty";
  const auto entry = polled.add(second.get());
  ASSERT_EQ(polled.wait(0), Outcome::done);
  EXPECT_FALSE(polled[entry]);
}

TEST(PollSet, ReportsTooManyDescriptors) {
  rlimit original_limit{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &original_limit), 0);
  auto [readable, peer] = connected();
  ASSERT_EQ(::write(peer.get(), "x", 1), 1);
  PollSet polled;
  const auto entry = polled.add(readable.get());
  polled.add(-1);
  rlimit one = original_limit;
  one.rlim_cur = 1;
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &one), 0);
  const Outcome outcome = polled.wait(0);
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &original_limit), 0);
  EXPECT_EQ(outcome, Outcome::too_many_descriptors);
  EXPECT_FALSE(polled[entry]) << "there are no events after a failure";
  EXPECT_EQ(polled.wait(0), Outcome::done);
  EXPECT_TRUE(polled[entry]);
}

TEST(PollSet, ASignalEndsTheWait) {
  struct sigaction action {};
  action.sa_handler = [](int) {};
  struct sigaction before {};
  ASSERT_EQ(::sigaction(SIGUSR1, &action, &before), 0);
  auto [quiet, peer] = connected();
  PollSet polled;
  const auto entry = polled.add(quiet.get());
  std::atomic<bool> stop{false};
  std::thread sender([&stop, receiver = ::pthread_self()] {
    while (!stop) {
      ::pthread_kill(receiver, SIGUSR1);
      ::usleep(1000);
    }
  });
  EXPECT_EQ(polled.wait(60 * ns_per_s), Outcome::done);
  stop = true;
  sender.join();
  EXPECT_FALSE(polled[entry]);
  ASSERT_EQ(::sigaction(SIGUSR1, &before, nullptr), 0);
}

}  // namespace
}  // namespace softgrip::net::poll_set_test
