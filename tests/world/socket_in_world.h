#pragma once
// The daemon's socket without a socket: lines in, lines out, through the daemon's own API.

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/socket/socket_api.h"

namespace softgrip::world {

class SocketInWorld {
 public:
  SocketInWorld(daemon::StatusSources sources, rig::SocketSettings settings,
                std::shared_ptr<const daemon::SequenceLoader> loader, const daemon::EventLog& events);

  /// A client. Its lines arrive at the service thread's next turn.
  [[nodiscard]] daemon::ClientId connect();
  void hang_up(daemon::ClientId client);
  void say(daemon::ClientId client, const nlohmann::ordered_json& line);
  /// The lines of the daemon to it since the last call, the oldest first.
  [[nodiscard]] std::vector<nlohmann::ordered_json> hear(daemon::ClientId client);

  /// A turn of the service thread.
  void serve(Nanoseconds now);

  /// The service thread takes a line of a client.
  std::function<void(const nlohmann::ordered_json& line)> on_line = [](const auto&) {};

 private:
  struct Arrival {
    daemon::ClientId client = 0;
    std::optional<nlohmann::ordered_json> line;  // nothing: it has hung up
  };
  void take(const Arrival& arrival, Nanoseconds now);

  daemon::ClientId last_ = 0;
  std::deque<Arrival> arrivals_;
  std::map<daemon::ClientId, std::vector<nlohmann::ordered_json>> said_;
  daemon::SocketApi api_;
};

}  // namespace softgrip::world
