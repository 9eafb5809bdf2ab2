#include "base/net/listener.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include <utility>
#include <vector>

namespace softgrip::net::listener_test {
namespace {

class EntranceTest : public ::testing::Test {
 protected:
  EntranceTest() {
    EXPECT_EQ(::getrlimit(RLIMIT_NOFILE, &usual_), 0);
    auto listener = listen_tcp("127.0.0.1", 0);
    port_ = listener->port;
    entrance_ = Entrance(std::move(listener->socket));
  }
  ~EntranceTest() override { ::setrlimit(RLIMIT_NOFILE, &usual_); }
  EntranceTest(const EntranceTest&) = delete;
  EntranceTest& operator=(const EntranceTest&) = delete;
  EntranceTest(EntranceTest&&) = delete;
  EntranceTest& operator=(EntranceTest&&) = delete;

  void connect() {
    Descriptor socket{::socket(AF_INET, SOCK_STREAM, 0)};
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port_);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ASSERT_EQ(::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    clients_.push_back(std::move(socket));
  }
  /// Prevents the process from opening any new file descriptor.
  void take_all_descriptors() {
    rlimit none = usual_;
    none.rlim_cur = 1;  // the limit is not 0, because poll() would then refuse to watch a descriptor
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  }
  /// Limits the number of open descriptors to the present number. The present number includes the spare
  /// descriptors that the object entrance_ holds and can close.
  void leave_the_spare_descriptors() {
    rlimit limit = usual_;
    limit.rlim_cur = static_cast<rlim_t>(::dup(0));
    ::close(static_cast<int>(limit.rlim_cur));
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &limit), 0);
  }
  bool would_wake(Nanoseconds now) const {
    pollfd watched{entrance_.descriptor(now), POLLIN, 0};
    return ::poll(&watched, 1, 0) > 0;
  }

  rlimit usual_{};
  std::uint16_t port_ = 0;
  Entrance entrance_;
  std::vector<Descriptor> clients_;
};

TEST_F(EntranceTest, AcceptsAClientOnlyIfOneIsWaiting) {
  EXPECT_FALSE(entrance_.accept(0));
  connect();
  EXPECT_TRUE(would_wake(0));
  EXPECT_TRUE(entrance_.accept(0));
  EXPECT_FALSE(entrance_.short_of_descriptors());
  EXPECT_FALSE(would_wake(0));
}

TEST_F(EntranceTest, PausesAcceptingWhileNoDescriptorIsFree) {
  connect();
  take_all_descriptors();
  constexpr Nanoseconds now = ns_per_s;
  EXPECT_FALSE(entrance_.accept(now));
  EXPECT_TRUE(entrance_.short_of_descriptors());
  EXPECT_FALSE(would_wake(now + Entrance::rest - 1))
      << "the waiting client is still in the queue of the listener";
  EXPECT_TRUE(would_wake(now + Entrance::rest));
  EXPECT_FALSE(entrance_.accept(now + Entrance::rest));
  EXPECT_FALSE(would_wake(now + Entrance::rest)) << "the listener accepts no client during the new pause";
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &usual_), 0);
  EXPECT_TRUE(entrance_.accept(now + 2 * Entrance::rest));
  EXPECT_FALSE(entrance_.short_of_descriptors());
}

TEST_F(EntranceTest, AcceptsOneClientWithTheSpareDescriptors) {
  connect();
  connect();
  leave_the_spare_descriptors();
  Descriptor first = entrance_.accept(0);
  EXPECT_TRUE(first);
  EXPECT_TRUE(entrance_.short_of_descriptors());
  const Descriptor needed{::dup(first.get())};
  EXPECT_TRUE(needed) << "the request can use the second spare descriptor";
  EXPECT_FALSE(entrance_.accept(0));
  EXPECT_FALSE(would_wake(0));
  first.reset();
  EXPECT_TRUE(entrance_.accept(Entrance::rest)) << "the descriptor of the first client is free again";
}

TEST_F(EntranceTest, AcceptsNoClientWithoutAListener) {
  Entrance none{Descriptor()};
  EXPECT_EQ(none.descriptor(0), -1);
  EXPECT_FALSE(none.accept(0));
}

}  // namespace
}  // namespace softgrip::net::listener_test
