#include "tests/daemon/service/softgripd_process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <thread>
#include <utility>

#include "tests/support/files.h"

namespace softgrip::daemon::testing {

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds patience(5000);
constexpr std::chrono::milliseconds pause(5);

Descriptor try_connect(const std::string& path) {
  Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path.data(), path.size());
  if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    socket.reset();
  return socket;
}

}  // namespace

ApiClient::ApiClient(const std::string& socket_path) {
  for (const auto end = Clock::now() + patience; !socket_ && Clock::now() < end;) {
    socket_ = try_connect(socket_path);
    if (!socket_) std::this_thread::sleep_for(pause);
  }
}

bool ApiClient::send(std::string_view text) {
  return ::send(socket_.get(), text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
}

nlohmann::json ApiClient::receive() {
  for (;;) {
    const std::size_t end = input_.find('\n');
    if (end != std::string::npos) {
      const std::string line = input_.substr(0, end);
      input_.erase(0, end + 1);
      return nlohmann::json::parse(line);
    }
    pollfd polled{socket_.get(), POLLIN, 0};
    if (::poll(&polled, 1, static_cast<int>(patience.count())) <= 0) return nullptr;
    std::string buffer(1 << 16, '\0');
    const ssize_t count = ::recv(socket_.get(), buffer.data(), buffer.size(), 0);
    if (count <= 0) return nullptr;
    input_.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

nlohmann::json ApiClient::ask(const nlohmann::json& request) {
  if (!send(request.dump() + "\n")) return nullptr;
  return receive();
}

SoftgripdProcess::SoftgripdProcess(const std::string& folder, const Start& start)
    : output_path_(folder + "/softgripd.log") {
  std::vector<std::string> words{SOFTGRIPD_PATH};
  words.insert(words.end(), start.arguments.begin(), start.arguments.end());
  pid_ = fork();
  if (pid_ != 0) return;
  const int output = ::open(output_path_.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  for (const std::string& variable : start.environment) putenv(const_cast<char*>(variable.c_str()));
  if (start.in_child) start.in_child();
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(SOFTGRIPD_PATH, arguments.data());
  _exit(127);
}

SoftgripdProcess::~SoftgripdProcess() {
  if (pid_ <= 0) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

void SoftgripdProcess::signal(int number) const {
  kill(pid_, number);
}

std::optional<int> SoftgripdProcess::wait(double timeout_s) {
  const auto end = Clock::now() + std::chrono::duration<double>(timeout_s);
  int status = 0;
  while (waitpid(pid_, &status, WNOHANG) == 0) {
    if (Clock::now() > end) return std::nullopt;
    std::this_thread::sleep_for(pause);
  }
  pid_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string SoftgripdProcess::output() const {
  return test::text_of(output_path_);
}

std::string make_rig(const std::string& folder,
                     const std::vector<std::pair<std::string, std::string>>& changes) {
  std::string text = test::text_of(SOFTGRIP_SOURCE_DIR "/config/rig.yaml");
  std::vector<std::pair<std::string, std::string>> all{
      {"cpus: [1]", "cpus: []"},
      {"/tmp/softgrip.sock", folder + "/socket"},
      {"/tmp/softgrip-runs", folder + "/runs"},
      {"sequence_directory: sequences", "sequence_directory: " SOFTGRIP_SOURCE_DIR "/config/sequences"},
      {"models/bench_twin.yaml", SOFTGRIP_SOURCE_DIR "/config/models/bench_twin.yaml"},
  };
  all.insert(all.end(), changes.begin(), changes.end());
  for (const auto& [from, to] : all) {
    EXPECT_NE(text.find(from), std::string::npos) << "config/rig.yaml has no '" << from << "'";
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
      text.replace(at, from.size(), to);
    }
  }
  const std::string path = folder + "/rig.yaml";
  std::ofstream(path) << text;
  return path;
}

}  // namespace softgrip::daemon::testing
