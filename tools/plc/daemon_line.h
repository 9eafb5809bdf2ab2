#pragma once
// The gateway's connection with softgripd: lines each way, and a new attempt after its end.

#include <optional>
#include <string>

#include "base/time.h"
#include "tools/client/daemon_client.h"
#include "tools/plc/gateway.h"

namespace softgrip::plc {

class DaemonLine {
 public:
  /// `path`: of the daemon's socket. `gateway` outlives it.
  DaemonLine(std::string path, Gateway& gateway) : path_(std::move(path)), gateway_(gateway) {}

  /// Connects if there is no connection, and hands the daemon's lines to the gateway. Waits for nothing.
  void receive(Nanoseconds now);
  /// Sends the gateway's lines.
  void send();
  /// For poll(); -1 without a connection.
  [[nodiscard]] int descriptor() const noexcept { return client_ ? client_->descriptor() : -1; }

 private:
  void connect(Nanoseconds now);
  void end();

  std::string path_;
  Gateway& gateway_;
  std::optional<tools::DaemonClient> client_;
  Nanoseconds tried_at_ = 0;  // to connect
};

}  // namespace softgrip::plc
