#include "tools/client/daemon_link.h"

#include <chrono>
#include <nlohmann/json.hpp>

namespace softgrip::tools {

bool DaemonLink::connect(Nanoseconds now) {
  constexpr Nanoseconds retry_pause = ns_per_s / 4;
  if (client_ || (tried_at_ != 0 && now - tried_at_ < retry_pause)) return false;
  tried_at_ = now;
  return !connect_now();
}

std::optional<ClientFailure> DaemonLink::connect_now() {
  if (client_) return std::nullopt;
  auto client = DaemonClient::connect_at_once(path_);
  if (!client) return std::move(client.error());
  client_.emplace(std::move(*client));
  return std::nullopt;
}

bool DaemonLink::hear(const std::function<void(nlohmann::ordered_json&)>& take) {
  while (client_) {
    auto line = client_->next_line(std::chrono::milliseconds(0));
    if (!line) {
      client_.reset();
    } else if (*line) {
      take(**line);
    } else {
      return true;
    }
  }
  return false;
}

}  // namespace softgrip::tools
