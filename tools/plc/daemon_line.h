#pragma once
// Connects the gateway to softgripd, and connects it again after a loss of the connection.

#include <optional>
#include <string>

#include "base/time.h"
#include "tools/client/daemon_client.h"
#include "tools/plc/gateway.h"

namespace softgrip::plc {

class DaemonLine {
 public:
  /// Creates the object without connecting. `path` is the path of the daemon's socket. `gateway` must outlive
  /// this object.
  DaemonLine(std::string path, Gateway& gateway) : path_(std::move(path)), gateway_(gateway) {}

  /// Connects to the daemon if there is no connection, and passes the lines received from the daemon to the
  /// gateway. Does not wait.
  void receive(Nanoseconds now);
  /// Takes the prepared requests from the gateway and sends them to the daemon.
  void send();
  /// Returns the descriptor of the connection for poll(), or -1 if there is no connection.
  [[nodiscard]] int descriptor() const noexcept { return client_ ? client_->descriptor() : -1; }

 private:
  void connect(Nanoseconds now);
  void end();

  std::string path_;
  Gateway& gateway_;
  std::optional<tools::DaemonClient> client_;
  Nanoseconds tried_at_ = 0;  // time of the last attempt to connect
};

}  // namespace softgrip::plc
