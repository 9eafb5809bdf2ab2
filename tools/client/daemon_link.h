#pragma once
// The connection of a gateway to the daemon. After a loss, the connection is opened again.

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include <nlohmann/json_fwd.hpp>

#include "base/time.h"
#include "tools/client/daemon_client.h"

namespace softgrip::tools {

/// The connection of a program that never waits for the daemon. After a loss of the connection, the program
/// connects again.
class DaemonLink {
 public:
  explicit DaemonLink(std::string path) : path_(std::move(path)) {}
  /// Connects if there is no connection, but tries at most once every 250 ms. Returns true if the connection
  /// is new.
  [[nodiscard]] bool connect(Nanoseconds now);
  /// Connects if there is no connection. If this fails, returns the reason.
  [[nodiscard]] std::optional<ClientFailure> connect_now();
  /// Passes the lines that have arrived from the daemon to `take`. Returns false if the connection has ended.
  [[nodiscard]] bool hear(const std::function<void(nlohmann::ordered_json&)>& take);
  void end() noexcept { client_.reset(); }
  [[nodiscard]] explicit operator bool() const noexcept { return client_.has_value(); }
  /// Sends a request to the daemon. There must be a connection.
  void send(const nlohmann::ordered_json& request) { client_->send(request); }
  /// Returns the descriptor of the connection for poll(), or -1 if there is no connection.
  [[nodiscard]] int descriptor() const noexcept { return client_ ? client_->descriptor() : -1; }

 private:
  std::string path_;
  std::optional<DaemonClient> client_;
  Nanoseconds tried_at_ = 0;  // time of the last attempt to connect by connect()
};

}  // namespace softgrip::tools
