#pragma once
// Runs softgripd as a separate process. Controls the process as a user does: with arguments, with signals and
// over its socket.

#include <sys/types.h>

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/descriptor.h"

namespace softgrip::daemon::testing {

/// A connection to the socket of a daemon.
class ApiClient {
 public:
  /// Tries for up to 5 s to connect. open() then returns true if the daemon has accepted the connection.
  explicit ApiClient(const std::string& socket_path);

  [[nodiscard]] bool open() const noexcept { return static_cast<bool>(socket_); }
  [[nodiscard]] int number() const noexcept { return socket_.get(); }
  bool send(std::string_view text);
  /// Returns the next line as JSON. Returns null if no line arrives within 5 s or if the connection has
  /// ended.
  [[nodiscard]] nlohmann::json receive();
  /// Sends a request and returns the reply of the daemon.
  nlohmann::json ask(const nlohmann::json& request);

 private:
  Descriptor socket_;
  std::string input_;
};

class SoftgripdProcess {
 public:
  struct Start {
    std::vector<std::string> arguments;
    std::vector<std::string> environment{};  ///< variables NAME=value of the daemon, in addition to the
                                             ///< environment of the test
    std::function<void()> in_child{};        ///< function to call in the child process between fork and exec
  };

  /// Starts softgripd. `folder` is the folder for the output of the process.
  SoftgripdProcess(const std::string& folder, const Start& start);
  SoftgripdProcess(const SoftgripdProcess&) = delete;
  SoftgripdProcess& operator=(const SoftgripdProcess&) = delete;
  SoftgripdProcess(SoftgripdProcess&&) = delete;
  SoftgripdProcess& operator=(SoftgripdProcess&&) = delete;
  /// Kills softgripd if it is still running.
  ~SoftgripdProcess();

  [[nodiscard]] pid_t pid() const noexcept { return pid_; }
  void signal(int number) const;
  /// Waits up to `timeout_s` for the end of the process. Returns the exit code, or 128 + the number of the
  /// signal that ended the process. Returns nullopt if the process is still running.
  std::optional<int> wait(double timeout_s = 20);
  /// Returns the text that the process has printed so far.
  [[nodiscard]] std::string output() const;

 private:
  pid_t pid_ = -1;
  std::string output_path_;
};

/// Writes a modified copy of config/rig.yaml for a test. In the copy, socket and recordings are in `folder`,
/// and no processor is requested. Each pair of `changes` contains a text of the file and its replacement.
/// Returns the path of the copy.
std::string make_rig(const std::string& folder,
                     const std::vector<std::pair<std::string, std::string>>& changes = {});

}  // namespace softgrip::daemon::testing
