#pragma once
// Runs the real socket API of the daemon (daemon::SocketApi) without a socket. The test passes the lines of
// clients to the API and reads the lines that the daemon sends.

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "daemon/socket/socket_api.h"

namespace softgrip::world {

class SocketInWorld {
 public:
  SocketInWorld(daemon::StatusSources sources, rig::SocketSettings settings,
                std::shared_ptr<const daemon::SequenceLoader> loader, const daemon::EventLog& events);

  /// Adds a client. The service thread detects the client in its next turn.
  [[nodiscard]] daemon::ClientId connect();
  void hang_up(daemon::ClientId client);
  void say(daemon::ClientId client, const nlohmann::ordered_json& line);
  /// Returns the lines that the daemon has sent to this client since the last call, oldest first.
  [[nodiscard]] std::vector<nlohmann::ordered_json> hear(daemon::ClientId client);

  /// Runs one turn of the service thread: reads the lines of clients and sends the lines of the daemon.
  void serve(Nanoseconds now);

  /// Called when the service thread reads a line of a client.
  std::function<void(const nlohmann::ordered_json& line)> on_line = [](const auto&) {};

 private:
  struct Arrival {
    daemon::ClientId client = 0;
    std::optional<nlohmann::ordered_json> line;  // text of the line; nullopt: the client has closed the
                                                 // connection
  };
  void take(const Arrival& arrival, Nanoseconds now);

  daemon::ClientId last_ = 0;
  std::deque<Arrival> arrivals_;
  std::map<daemon::ClientId, std::vector<nlohmann::ordered_json>> said_;
  daemon::SocketApi api_;
};

}  // namespace softgrip::world
