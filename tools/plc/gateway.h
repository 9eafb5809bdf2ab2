#pragma once
// Converts between Modbus registers and JSON lines of the daemon. The gateway has no sockets and no clock:
// its owner passes the received data and the time to the gateway, and sends the output of the gateway.

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/time.h"
#include "drivers/modbus_server/registers.h"
#include "drivers/modbus_server/requests.h"
#include "rig/plc_file/settings.h"
#include "tools/plc/client_connections.h"
#include "tools/plc/handshake.h"
#include "tools/plc/heartbeat_monitor.h"

namespace softgrip::plc {

class Gateway {
 public:
  /// Creates a gateway that is not connected to a daemon. `settings` must outlive the gateway.
  explicit Gateway(const Settings& settings);

  /// Returns the connected clients (Modbus masters). The owner adds and removes connections through this
  /// object. The owner must close each connection that this object has removed.
  [[nodiscard]] ClientConnections& connections() noexcept { return connections_; }
  [[nodiscard]] const ClientConnections& connections() const noexcept { return connections_; }
  /// Returns the response to a request of the connection `id`. If the request contains a command, passes the
  /// command to the daemon.
  [[nodiscard]] modbus::Reply serve(ClientConnections::Id id, const modbus::Request& request,
                                    Nanoseconds now);
  /// Allows the connection `id` to start a sequence again after a silence of a client. Must be called when
  /// all received requests of the connection have been served. Each later request is assumed to be newer than
  /// the silence, because a client normally sends it after the responses.
  void on_requests_served(ClientConnections::Id id);
  /// Processes the waiting command and the silent clients. Must be called after the daemon's lines were
  /// processed, and at least every `max_update_period`.
  void update(Nanoseconds now);
  static constexpr Nanoseconds max_update_period = 20'000'000;

  /// Notes that the connection to the daemon was opened. Must be called after each new connection.
  void on_daemon_connected(Nanoseconds now);
  /// Processes one line that the daemon has sent.
  void on_daemon_line(const nlohmann::ordered_json& line, Nanoseconds now);
  /// Notes that the connection to the daemon has ended. Must be called after each loss of the connection.
  void on_daemon_disconnected() noexcept;
  /// Returns the lines that must be sent to the daemon, the oldest line first, and removes them from the
  /// gateway.
  [[nodiscard]] std::vector<nlohmann::ordered_json> take_lines_to_daemon();

  [[nodiscard]] const Handshake& handshake() const noexcept { return handshake_; }
  [[nodiscard]] const HeartbeatMonitor& heartbeat_monitor() const noexcept { return heartbeat_monitor_; }
  /// Returns true if a daemon is connected and has sent its status within the permitted time.
  [[nodiscard]] bool daemon_responds(Nanoseconds now) const noexcept;
  /// Returns the counters of the commands to which the daemon has not responded, the oldest command first.
  [[nodiscard]] std::vector<std::uint16_t> pending_counters() const;
  /// reaction_pending() returns true if a stop, vent or release was sent because a client is silent, and the
  /// daemon has not responded to this command. reaction_covers_silence() returns true if the response to this
  /// command also covers the latest silence of a client.
  [[nodiscard]] bool reaction_pending() const noexcept { return reaction_id_.has_value(); }
  [[nodiscard]] bool reaction_covers_silence() const noexcept {
    return reaction_id_ && reaction_covers_silence_;
  }

 private:
  void process_counter(ClientConnection& connection, Nanoseconds now);
  void execute(const Handshake::Entry& entry, Nanoseconds now);
  void check_heartbeat(Nanoseconds now);
  void send_reaction(Nanoseconds now);
  std::uint64_t send(nlohmann::ordered_json request);
  void write_registers(const ClientConnection& connection, Nanoseconds now);

  const Settings& settings_;
  modbus::Registers registers_;
  ClientConnections connections_;
  Handshake handshake_;
  HeartbeatMonitor heartbeat_monitor_;
  bool connected_ = false;
  Nanoseconds last_status_at_ = 0;  // time at which the daemon last sent its status
  std::vector<nlohmann::ordered_json> to_daemon_;
  std::uint64_t last_id_ = 0;
  std::map<std::uint64_t, std::uint16_t> pending_commands_;  // counter of each command that has no response,
                                                             // by request id
  // Request id of the stop, vent or release that was sent because of a silent client; nullopt: no such
  // command waits for a response.
  std::optional<std::uint64_t> reaction_id_;
  bool reaction_covers_silence_ =
      false;  // true: no client has become silent since the pending stop, vent or release was sent
  Nanoseconds reaction_sent_at_ = 0;
};

}  // namespace softgrip::plc
