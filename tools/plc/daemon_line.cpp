#include "tools/plc/daemon_line.h"

#include <chrono>
#include <utility>

#include <nlohmann/json.hpp>

namespace softgrip::plc {

namespace {

/// Shortest time between two attempts to connect to the daemon.
constexpr Nanoseconds retry_pause = ns_per_s / 4;

}  // namespace

void DaemonLine::receive(Nanoseconds now) {
  if (!client_) connect(now);
  while (client_) {
    auto line = client_->next_line(std::chrono::milliseconds(0));
    if (!line) {
      end();
    } else if (*line) {
      gateway_.daemon_said(**line, now);
    } else {
      break;
    }
  }
}

void DaemonLine::send() {
  if (!client_) return;
  for (const auto& line : gateway_.lines_to_daemon()) client_->send(line);
}

void DaemonLine::connect(Nanoseconds now) {
  if (tried_at_ != 0 && now - tried_at_ < retry_pause) return;
  tried_at_ = now;
  auto client = tools::DaemonClient::connect_at_once(path_);
  if (!client) return;
  client_.emplace(std::move(*client));
  gateway_.daemon_came(now);
}

void DaemonLine::end() {
  client_.reset();
  gateway_.daemon_went();
}

}  // namespace softgrip::plc
