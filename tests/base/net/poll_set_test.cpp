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
  auto [heard, heard_peer] = connected();
  auto [left, left_peer] = connected();
  ASSERT_EQ(::write(heard_peer.get(), "x", 1), 1);
  left_peer.reset();
  PollSet polled;
  const auto none = polled.add(-1);
  const auto idle = polled.add(quiet.get());
  const auto input = polled.add(heard.get());
  const auto output = polled.add(quiet.get(), true, true);
  const auto ended = polled.add(left.get(), false);
  const auto ignored = polled.add(heard.get(), false);
  const auto invalid = polled.add(1'000'000);
  ASSERT_EQ(polled.wait(ns_per_s), Outcome::over);
  EXPECT_FALSE(polled[none]);
  EXPECT_FALSE(polled[idle]);
  EXPECT_TRUE(polled[input] && polled[input].input());
  EXPECT_FALSE(polled[input].output() || polled[input].ended() || polled[input].invalid());
  EXPECT_TRUE(polled[output] && polled[output].output());
  EXPECT_FALSE(polled[output].input());
  EXPECT_TRUE(polled[ended] && polled[ended].ended());
  EXPECT_FALSE(polled[ended].input());
  EXPECT_FALSE(polled[ignored]);
  EXPECT_TRUE(polled[invalid] && polled[invalid].invalid());
}

TEST(PollSet, TheWaitEndsAtTheTimeout) {
  auto [quiet, peer] = connected();
  PollSet polled;
  const auto place = polled.add(quiet.get());
  EXPECT_EQ(polled.wait(0), Outcome::over);
  EXPECT_EQ(polled.wait(ns_per_s / 1000), Outcome::over);
  EXPECT_FALSE(polled[place]);
}

TEST(PollSet, CanBeReusedAfterClear) {
  auto [first, first_peer] = connected();
  auto [second, second_peer] = connected();
  ASSERT_EQ(::write(first_peer.get(), "x", 1), 1);
  PollSet polled;
  const auto old = polled.add(first.get());
  ASSERT_EQ(polled.wait(0), Outcome::over);
  EXPECT_TRUE(polled[old]);
  EXPECT_FALSE(polled[PollSet::Place()]) << "a place without a descriptor";
  polled.clear();
  ASSERT_EQ(polled.wait(0), Outcome::over);
  EXPECT_FALSE(polled[old]) << "the set is empty";
  const auto place = polled.add(second.get());
  ASSERT_EQ(polled.wait(0), Outcome::over);
  EXPECT_FALSE(polled[place]);
}

TEST(PollSet, ReportsTooManyDescriptors) {
  rlimit usual{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &usual), 0);
  auto [heard, peer] = connected();
  ASSERT_EQ(::write(peer.get(), "x", 1), 1);
  PollSet polled;
  const auto place = polled.add(heard.get());
  polled.add(-1);
  rlimit one = usual;
  one.rlim_cur = 1;
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &one), 0);
  const Outcome outcome = polled.wait(0);
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &usual), 0);
  EXPECT_EQ(outcome, Outcome::too_many);
  EXPECT_FALSE(polled[place]) << "there are no events after a failure";
  EXPECT_EQ(polled.wait(0), Outcome::over);
  EXPECT_TRUE(polled[place]);
}

TEST(PollSet, ASignalEndsTheWait) {
  struct sigaction action {};
  action.sa_handler = [](int) {};
  struct sigaction before {};
  ASSERT_EQ(::sigaction(SIGUSR1, &action, &before), 0);
  auto [quiet, peer] = connected();
  PollSet polled;
  const auto place = polled.add(quiet.get());
  std::atomic<bool> over{false};
  std::thread sender([&over, receiver = ::pthread_self()] {
    while (!over) {
      ::pthread_kill(receiver, SIGUSR1);
      ::usleep(1000);
    }
  });
  EXPECT_EQ(polled.wait(60 * ns_per_s), Outcome::over);
  over = true;
  sender.join();
  EXPECT_FALSE(polled[place]);
  ASSERT_EQ(::sigaction(SIGUSR1, &before, nullptr), 0);
}

}  // namespace
}  // namespace softgrip::net::poll_set_test
