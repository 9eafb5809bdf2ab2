#pragma once
// softgripd as a process of its own, spoken to as users do: arguments, signals, its socket.

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

/// A connection to the socket API.
class ApiClient {
 public:
  /// Tries for five seconds. Not open() if the daemon did not answer.
  explicit ApiClient(const std::string& socket_path);

  [[nodiscard]] bool open() const noexcept { return static_cast<bool>(socket_); }
  [[nodiscard]] int number() const noexcept { return socket_.get(); }
  bool send(std::string_view text);
  /// The next line, as JSON; null after five seconds of silence or the end of the connection.
  [[nodiscard]] nlohmann::json receive();
  /// A request and its reply.
  nlohmann::json ask(const nlohmann::json& request);

 private:
  Descriptor socket_;
  std::string input_;
};

class SoftgripdProcess {
 public:
  struct Start {
    std::vector<std::string> arguments;
    std::vector<std::string> environment{};  ///< NAME=value, besides the test's own
    std::function<void()> in_child{};        ///< between fork and exec
  };

  /// `folder`: where its output goes.
  SoftgripdProcess(const std::string& folder, const Start& start);
  SoftgripdProcess(const SoftgripdProcess&) = delete;
  SoftgripdProcess& operator=(const SoftgripdProcess&) = delete;
  SoftgripdProcess(SoftgripdProcess&&) = delete;
  SoftgripdProcess& operator=(SoftgripdProcess&&) = delete;
  /// Kills it if it still runs.
  ~SoftgripdProcess();

  [[nodiscard]] pid_t pid() const noexcept { return pid_; }
  void signal(int number) const;
  /// Its exit code, 128 + the signal that ended it, or nothing if it still runs after `timeout_s`.
  std::optional<int> wait(double timeout_s = 20);
  /// Returns the text that it has printed so far.
  [[nodiscard]] std::string output() const;

 private:
  pid_t pid_ = -1;
  std::string output_path_;
};

/// config/rig.yaml for a test: its socket and recordings in `folder`, no processor requested; each pair of
/// `changes` replaces a text that must be there. Returns the path of the file.
std::string make_rig(const std::string& folder,
                     const std::vector<std::pair<std::string, std::string>>& changes = {});

}  // namespace softgrip::daemon::testing
