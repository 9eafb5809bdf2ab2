// The server on a real socket, without a daemon behind it.

#include "tools/web/server.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <array>
#include <string>
#include <thread>
#include <vector>

#include "drivers/modbus_server/listener.h"
#include "tools/web/page/page_files.h"

namespace softgrip::web::server_test {
namespace {

class ServerTest : public ::testing::Test {
 protected:
  ServerTest() {
    settings_.max_connections = 8;
    settings_.without_token = Role::operate;
    settings_.look_socket = settings_.operate_socket = "/nowhere/softgripd.sock";
    auto listener = modbus::listen_tcp("127.0.0.1", 0);
    port_ = listener->port;
    Descriptor signals{::eventfd(0, 0)};
    end_ = Descriptor(::dup(signals.get()));
    thread_ =
        std::thread([this, socket = std::move(listener->socket), signals = std::move(signals)]() mutable {
          Server(settings_, {}, "", std::move(socket), std::move(signals)).run();
        });
  }
  ~ServerTest() override {
    ::eventfd_write(end_.get(), 1);
    thread_.join();
  }
  ServerTest(const ServerTest&) = delete;
  ServerTest& operator=(const ServerTest&) = delete;
  ServerTest(ServerTest&&) = delete;
  ServerTest& operator=(ServerTest&&) = delete;

  Descriptor connect() const {
    Descriptor socket{::socket(AF_INET, SOCK_STREAM, 0)};
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port_);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    const timeval patience{30, 0};
    ::setsockopt(socket.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    return socket;
  }
  static std::string all_from(const Descriptor& socket) {
    std::string text;
    std::array<char, 4096> bytes;
    for (ssize_t count = 0; (count = ::recv(socket.get(), bytes.data(), bytes.size(), 0)) > 0;)
      text.append(bytes.data(), static_cast<std::size_t>(count));
    return text;
  }
  std::string ask(const std::string& request) const {
    const Descriptor socket = connect();
    EXPECT_GT(::send(socket.get(), request.data(), request.size(), MSG_NOSIGNAL), 0);
    return all_from(socket);
  }

  Settings settings_;
  std::uint16_t port_ = 0;
  Descriptor end_;
  std::thread thread_;
};

const std::string get_page = "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n";

TEST_F(ServerTest, AnswersAndEndsTheConnection) {
  const std::string page = ask(get_page);
  EXPECT_TRUE(page.starts_with("HTTP/1.1 200 OK\r\n")) << page;
  EXPECT_TRUE(page.ends_with(page_html()));
  EXPECT_TRUE(ask("nonsense\r\n\r\n").starts_with("HTTP/1.1 400 "));
  EXPECT_TRUE(ask("GET /page.css HTTP/1.1\r\nHost: localhost\r\n\r\n").ends_with(page_css()));
  EXPECT_TRUE(ask("GET /page.js HTTP/1.1\r\nHost: localhost\r\n\r\n").ends_with(page_js()));
}

TEST_F(ServerTest, WhoSaysNothingGivesWayToWhoAsks) {
  std::vector<Descriptor> silent;
  for (std::size_t i = 0; i < settings_.max_connections; ++i) silent.push_back(connect());
  std::string answer;
  for (int attempt = 0; attempt < 100 && !answer.starts_with("HTTP/1.1 200"); ++attempt) {
    answer = ask(get_page);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 200")) << answer;
}

TEST_F(ServerTest, ACommandWithoutADaemonSaysSo) {
  const std::string answer =
      ask("POST /api/command HTTP/1.1\r\nHost: localhost\r\nOrigin: http://localhost\r\n"
          "Content-Type: application/json\r\nContent-Length: 18\r\n\r\n{\"command\":\"stop\"}");
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 503")) << answer;
}

}  // namespace
}  // namespace softgrip::web::server_test
