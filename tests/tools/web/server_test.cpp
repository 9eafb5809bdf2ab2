// Tests the web server with clients on real sockets. No softgripd runs; some tests simulate it.

#include "tools/web/server.h"
#include "base/files.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/net/listener.h"
#include "tools/web/connection_limits.h"
#include "tools/web/site.h"

namespace softgrip::web::server_test {
namespace {

namespace fs = std::filesystem;

class ServerTest : public ::testing::Test {
 protected:
  ServerTest() {
    fs::create_directories(folder_ / "runs" / "one");
    std::ofstream(folder_ / "runs" / "one" / "run.csv") << large_;
    settings_.max_connections = 8;
    settings_.without_token = Role::operate;
    settings_.look_socket = "/nowhere/softgripd.sock";
    settings_.operate_socket = folder_ / "softgripd.sock";
    settings_.recordings = folder_ / "runs";
    auto listener = net::listen_tcp("127.0.0.1", 0);
    port_ = listener->port;
    Descriptor signals{::eventfd(0, 0)};
    end_ = Descriptor(::dup(signals.get()));
    thread_ =
        std::thread([this, socket = std::move(listener->socket), signals = std::move(signals)]() mutable {
          Server(settings_, {}, large_, std::move(socket), std::move(signals)).run();
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
    // A small receive buffer of the client, so that most of a large response remains in the server.
    const int small = 4096;
    ::setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
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
  static void send_text(const Descriptor& socket, const std::string& request) {
    EXPECT_GT(::send(socket.get(), request.data(), request.size(), MSG_NOSIGNAL), 0);
  }
  std::string ask(const std::string& request) const {
    const Descriptor socket = connect();
    send_text(socket, request);
    return all_from(socket);
  }
  /// Sends the request at most 100 times, until the server has a free connection. Returns the last response.
  std::string ask_with_retries(const std::string& request) const {
    std::string answer;
    for (int attempt = 0; attempt < 100 && (answer.empty() || answer.starts_with(refused)); ++attempt) {
      if (attempt > 0) std::this_thread::sleep_for(std::chrono::milliseconds(50));
      answer = ask(request);
    }
    return answer;
  }

  static constexpr const char* refused = "HTTP/1.1 503 Refused";
  const ScratchFolder scratch_;
  fs::path folder_ = scratch_.path();
  std::string large_ = std::string(3'000'000, 'r') + "end";
  Settings settings_;
  std::uint16_t port_ = 0;
  Descriptor end_;
  std::thread thread_;
};

const std::string get_file = "GET /recordings/one/run.csv HTTP/1.1\r\nHost: localhost\r\n\r\n";
const std::string get_stream = "GET /api/stream HTTP/1.1\r\nHost: localhost\r\n\r\n";
const std::string post_stop =
    "POST /api/command HTTP/1.1\r\nHost: localhost\r\nOrigin: http://localhost\r\n"
    "Content-Type: application/json\r\nContent-Length: 18\r\n\r\n{\"command\":\"stop\"}";
const std::string get_page = "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n";

TEST_F(ServerTest, AnswersAndEndsTheConnection) {
  const std::string page = ask(get_page);
  EXPECT_TRUE(page.starts_with("HTTP/1.1 200 OK\r\n")) << page;
  EXPECT_TRUE(page.ends_with(page_html()));
  EXPECT_TRUE(ask("nonsense\r\n\r\n").starts_with("HTTP/1.1 400 "));
  EXPECT_TRUE(ask("GET /page.css HTTP/1.1\r\nHost: localhost\r\n\r\n").ends_with(page_css()));
  EXPECT_TRUE(ask("GET /page.js HTTP/1.1\r\nHost: localhost\r\n\r\n").ends_with(page_js()));
}

TEST_F(ServerTest, ARequestReplacesASilentConnection) {
  std::vector<Descriptor> silent;
  for (std::size_t i = 0; i < settings_.max_connections; ++i) silent.push_back(connect());
  const std::string answer = ask_with_retries(get_page);
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 200")) << answer;
}

TEST_F(ServerTest, ACommandWithoutADaemonHasStatus503) {
  const std::string answer = ask(post_stop);
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 503")) << answer;
  EXPECT_NE(answer.find("no_daemon"), std::string::npos) << answer;
}

TEST_F(ServerTest, SendsALargeFileCompletely) {
  const std::string answer = ask(get_file);
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 200")) << answer.substr(0, 200);
  EXPECT_NE(answer.find("Content-Length: " + std::to_string(large_.size()) + "\r\n"), std::string::npos);
  EXPECT_TRUE(answer.ends_with("\r\n\r\n" + large_));
}

TEST_F(ServerTest, AHalfClosedConnectionReceivesDataFromDisk) {
  for (const std::string& request :
       {get_file, std::string("GET /metrics HTTP/1.1\r\nHost: localhost\r\n\r\n"),
        std::string("GET /api/recordings HTTP/1.1\r\nHost: localhost\r\n\r\n")}) {
    const Descriptor socket = connect();
    send_text(socket, request);
    ASSERT_EQ(::shutdown(socket.get(), SHUT_WR), 0);
    EXPECT_TRUE(all_from(socket).starts_with("HTTP/1.1 200")) << request;
  }
}

TEST_F(ServerTest, UnreadDownloadsDoNotBlockCommands) {
  std::vector<Descriptor> unread;
  for (std::size_t i = 0; i < 3 * settings_.max_connections; ++i) {
    unread.push_back(connect());
    send_text(unread.back(), get_file);
    const std::string answer = ask_with_retries(post_stop);
    ASSERT_NE(answer.find("no_daemon"), std::string::npos) << i << ": " << answer;
  }
  const std::string file = ask_with_retries(get_file);
  EXPECT_TRUE(file.ends_with(large_)) << "a client that reads replaces one that does not read";
}

TEST_F(ServerTest, CountsAConnectionWhoseResponseDoesNotFit) {
  const auto rejected = [this] {
    const std::string name = "\nsoftgrip_web_turned_away_total ";
    const std::string metrics = ask("GET /metrics HTTP/1.1\r\nHost: localhost\r\n\r\n");
    const std::size_t at = metrics.find(name);
    return at == std::string::npos ? -1 : std::stoi(metrics.substr(at + name.size()));
  };
  std::vector<Descriptor> streams;
  for (std::size_t i = 0; i < max_long_lived(settings_.max_connections); ++i) {
    streams.push_back(connect());
    send_text(streams.back(), get_stream);
    char first = 0;
    ASSERT_EQ(::recv(streams.back().get(), &first, 1, 0), 1);
  }
  const int before = rejected();
  ASSERT_GE(before, 0);
  // The client of this response does not read at first, so the response needs the place of a long-lived
  // connection.
  const Descriptor slow = connect();
  send_text(slow, "GET /chart.js HTTP/1.1\r\nHost: localhost\r\n\r\n");
  for (int attempt = 0; attempt < 100 && rejected() == before; ++attempt)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(rejected(), before + 1);
  EXPECT_LT(all_from(slow).size(), large_.size());
}

TEST_F(ServerTest, ATruncatedFileEndsTheResponse) {
  const Descriptor socket = connect();
  send_text(socket, get_file);
  char first = 0;
  ASSERT_EQ(::recv(socket.get(), &first, 1, 0), 1);
  fs::resize_file(folder_ / "runs" / "one" / "run.csv", 10);
  EXPECT_LT(all_from(socket).size(), large_.size());
  EXPECT_TRUE(ask(get_page).starts_with("HTTP/1.1 200"));
}

/// A simulated daemon. It responds to a command when the test calls a function.
class ScriptedDaemon {
 public:
  explicit ScriptedDaemon(const std::string& path) : listener_(std::move(*net::listen_unix(path))) {}
  /// Returns the next command that the server sends. Returns null if no command arrives within 10 s.
  nlohmann::json next_command() {
    for (;;) {
      const std::size_t end = text_.find('\n');
      if (end != std::string::npos) {
        auto request = nlohmann::json::parse(text_.substr(0, end));
        text_.erase(0, end + 1);
        if (request["command"] != "hello") return request;
        continue;
      }
      pollfd watched{socket_ ? socket_.get() : listener_.get(), POLLIN, 0};
      if (::poll(&watched, 1, 10'000) != 1) return nullptr;
      if (!socket_) {
        socket_ = net::accept_client(listener_);
        continue;
      }
      std::array<char, 4096> bytes;
      const ssize_t count = ::recv(socket_.get(), bytes.data(), bytes.size(), 0);
      if (count <= 0) return nullptr;
      text_.append(bytes.data(), static_cast<std::size_t>(count));
    }
  }
  void answer(const nlohmann::json& command) {
    const nlohmann::json reply{{"id", command["id"]}, {"ok", true}, {"result", {{"heard", true}}}};
    const std::string line = reply.dump() + "\n";
    EXPECT_GT(::send(socket_.get(), line.data(), line.size(), MSG_NOSIGNAL), 0);
  }

 private:
  Descriptor listener_;
  Descriptor socket_;
  std::string text_;
};

TEST_F(ServerTest, DisconnectedClientsDoNotBlockCommandsOfOthers) {
  ScriptedDaemon daemon(settings_.operate_socket);
  for (std::size_t i = 0; i < 3 * Commander::max_pending; ++i) {
    Descriptor leaving = connect();
    send_text(leaving, post_stop);
    ASSERT_FALSE(daemon.next_command().is_null()) << i;
    const linger at_once{1, 0};
    ::setsockopt(leaving.get(), SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
    leaving.reset();
  }
  const Descriptor waiting = connect();
  send_text(waiting, post_stop);
  const auto command = daemon.next_command();
  ASSERT_FALSE(command.is_null());
  daemon.answer(command);
  EXPECT_NE(all_from(waiting).find("heard"), std::string::npos);
}

}  // namespace
}  // namespace softgrip::web::server_test
