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

class AcceptorTest : public ::testing::Test {
 protected:
  AcceptorTest() {
    EXPECT_EQ(::getrlimit(RLIMIT_NOFILE, &original_limit_), 0);
    auto listener = listen_tcp("127.0.0.1", 0);
    port_ = listener->port;
    acceptor_ = Acceptor(std::move(listener->socket));
  }
  ~AcceptorTest() override { ::setrlimit(RLIMIT_NOFILE, &original_limit_); }
  AcceptorTest(const AcceptorTest&) = delete;
  AcceptorTest& operator=(const AcceptorTest&) = delete;
  AcceptorTest(AcceptorTest&&) = delete;
  AcceptorTest& operator=(AcceptorTest&&) = delete;

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
  void exhaust_descriptors() {
    rlimit none = original_limit_;
    none.rlim_cur = 1;  // the limit is not 0, because poll() would then refuse to watch a descriptor
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  }
  /// Limits the number of open descriptors to the present number. The present number includes the spare
  /// descriptors that the object acceptor_ holds and can close.
  void leave_only_spares() {
    rlimit limit = original_limit_;
    limit.rlim_cur = static_cast<rlim_t>(::dup(0));
    ::close(static_cast<int>(limit.rlim_cur));
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &limit), 0);
  }
  bool is_readable(Nanoseconds now) const {
    pollfd watched{acceptor_.descriptor(now), POLLIN, 0};
    return ::poll(&watched, 1, 0) > 0;
  }

  rlimit original_limit_{};
  std::uint16_t port_ = 0;
  Acceptor acceptor_;
  std::vector<Descriptor> clients_;
};

TEST_F(AcceptorTest, AcceptsAClientOnlyIfOneIsWaiting) {
  EXPECT_FALSE(acceptor_.accept(0));
  connect();
  EXPECT_TRUE(is_readable(0));
  EXPECT_TRUE(acceptor_.accept(0));
  EXPECT_FALSE(acceptor_.out_of_descriptors());
  EXPECT_FALSE(is_readable(0));
}

TEST_F(AcceptorTest, PausesAcceptingWhileNoDescriptorIsFree) {
  connect();
  exhaust_descriptors();
  constexpr Nanoseconds now = ns_per_s;
  EXPECT_FALSE(acceptor_.accept(now));
  EXPECT_TRUE(acceptor_.out_of_descriptors());
  EXPECT_FALSE(is_readable(now + Acceptor::retry_pause - 1))
      << "during the pause, the listener is not watched, although a client waits";
  EXPECT_TRUE(is_readable(now + Acceptor::retry_pause));
  EXPECT_FALSE(acceptor_.accept(now + Acceptor::retry_pause));
  EXPECT_FALSE(is_readable(now + Acceptor::retry_pause))
      << "the listener accepts no client during the new pause";
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &original_limit_), 0);
  EXPECT_TRUE(acceptor_.accept(now + 2 * Acceptor::retry_pause));
  EXPECT_FALSE(acceptor_.out_of_descriptors());
}

TEST_F(AcceptorTest, AcceptsOneClientWithTheSpareDescriptors) {
  connect();
  connect();
  leave_only_spares();
  Descriptor first = acceptor_.accept(0);
  EXPECT_TRUE(first);
  EXPECT_TRUE(acceptor_.out_of_descriptors());
  const Descriptor needed{::dup(first.get())};
  EXPECT_TRUE(needed) << "one more descriptor is free for the work that the client requests";
  EXPECT_FALSE(acceptor_.accept(0));
  EXPECT_FALSE(is_readable(0));
  first.reset();
  EXPECT_TRUE(acceptor_.accept(Acceptor::retry_pause)) << "the descriptor of the first client is free again";
}

TEST_F(AcceptorTest, AcceptsNoClientWithoutAListener) {
  Acceptor none{Descriptor()};
  EXPECT_EQ(none.descriptor(0), -1);
  EXPECT_FALSE(none.accept(0));
}

TEST(NormalAddress, AllNotationsOfAnAddressAreEqual) {
  EXPECT_EQ(normal_address("10.0.0.5"), "10.0.0.5");
  EXPECT_EQ(normal_address("::FFFF:10.0.0.5"), "10.0.0.5");
  EXPECT_EQ(normal_address("FE80:0:0:0:0:0:0:1"), "fe80::1");
  EXPECT_EQ(normal_address("0:0::1"), "::1");
  EXPECT_EQ(normal_address("fe80::1%eth0"), "fe80::1%eth0");
  EXPECT_EQ(normal_address("plc"), "plc");
}

}  // namespace
}  // namespace softgrip::net::listener_test
