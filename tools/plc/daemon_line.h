#pragma once
// Connects the gateway to softgripd, and reconnects after a loss of the connection.

#include <optional>
#include <string>

#include "base/time.h"
#include "tools/client/daemon_client.h"
#include "tools/plc/gateway.h"

namespace softgrip::plc {

class DaemonLine {
 public:
  /// `path` is the path of the daemon's socket. `gateway` must outlive this object.
  DaemonLine(std::string path, Gateway& gateway) : path_(std::move(path)), gateway_(gateway) {}

  /// Connects if there is no connection, and passes the daemon's lines to the gateway. Does not wait.
  void receive(Nanoseconds now);
  /// Sends the lines of the gateway to the daemon.
  void send();
  /// Returns the descriptor for poll(), or -1 without a connection.
  [[nodiscard]] int descriptor() const noexcept { return client_ ? client_->descriptor() : -1; }

 private:
  void connect(Nanoseconds now);
  void end();

  std::string path_;
  Gateway& gateway_;
  std::optional<tools::DaemonClient> client_;
  Nanoseconds tried_at_ = 0;  // last attempt to connect
};

}  // namespace softgrip::plc
