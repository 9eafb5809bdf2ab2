#pragma once
// Runs softgripd as a separate process and controls it as a user does, with arguments, signals and its
// socket.

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/descriptor.h"

namespace softgrip::daemon::testing {

/// A connection to the socket API of a daemon.
class ApiClient {
 public:
  /// Tries to connect for 5 s. open() is false if the daemon did not answer.
  explicit ApiClient(const std::string& socket_path);

  [[nodiscard]] bool open() const noexcept { return static_cast<bool>(socket_); }
  [[nodiscard]] int number() const noexcept { return socket_.get(); }
  bool send(std::string_view text);
  /// Returns the next line as JSON, or null after 5 s without a line or after the end of the connection.
  [[nodiscard]] nlohmann::json receive();
  /// Sends a request and returns its reply.
  nlohmann::json ask(const nlohmann::json& request);

 private:
  Descriptor socket_;
  std::string input_;
};

class SoftgripdProcess {
 public:
  struct Start {
    std::vector<std::string> arguments;
    std::vector<std::string> environment{};  ///< NAME=value, in addition to the test's environment
    std::function<void()> in_child{};        ///< called in the child process between fork and exec
  };

  /// `folder`: folder of its output.
  SoftgripdProcess(const std::string& folder, const Start& start);
  SoftgripdProcess(const SoftgripdProcess&) = delete;
  SoftgripdProcess& operator=(const SoftgripdProcess&) = delete;
  SoftgripdProcess(SoftgripdProcess&&) = delete;
  SoftgripdProcess& operator=(SoftgripdProcess&&) = delete;
  /// Kills the process if it is still running.
  ~SoftgripdProcess();

  [[nodiscard]] pid_t pid() const noexcept { return pid_; }
  void signal(int number) const;
  /// Returns the exit code, or 128 + the signal that ended the process, or nullopt if it is still running
  /// after `timeout_s`.
  std::optional<int> wait(double timeout_s = 20);
  /// Returns the text that the process has printed until now.
  [[nodiscard]] std::string output() const;

 private:
  pid_t pid_ = -1;
  std::string output_path_;
};

/// Writes a copy of config/rig.yaml for a test, with its socket and recordings in `folder` and without the
/// request for a processor. Each pair of `changes` replaces its first text, which must exist, by its second
/// text. Returns the path of the file.
std::string make_rig(const std::string& folder,
                     const std::vector<std::pair<std::string, std::string>>& changes = {});

}  // namespace softgrip::daemon::testing
