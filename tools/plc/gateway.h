#pragma once
// Converts between Modbus registers and JSON lines of the daemon. The gateway has no sockets and no clock.
// Its owner passes the received data and the time to it, and sends the results.

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/time.h"
#include "drivers/modbus_server/registers.h"
#include "drivers/modbus_server/reply.h"
#include "rig/plc_file/settings.h"
#include "tools/plc/handshake.h"
#include "tools/plc/master_watch.h"
#include "tools/plc/masters.h"

namespace softgrip::plc {

class Gateway {
 public:
  /// `settings` must outlive the gateway.
  explicit Gateway(const Settings& settings);

  /// Returns the connected clients (Modbus masters). The owner adds and removes connections through this
  /// object. It must close a connection that has lost its place.
  [[nodiscard]] Masters& masters() noexcept { return masters_; }
  [[nodiscard]] const Masters& masters() const noexcept { return masters_; }
  /// Returns the response to a request of a client that has a place, and passes the client's command to the
  /// daemon.
  [[nodiscard]] modbus::Reply serve(Masters::Id id, const modbus::Request& request, Nanoseconds now);
  /// Processes waiting commands and silent clients. Call it after processing the daemon's lines, and at least
  /// every `longest_pause`.
  void look_after(Nanoseconds now);
  static constexpr Nanoseconds longest_pause = 20'000'000;

  /// Call it when the connection to the daemon was opened.
  void daemon_came(Nanoseconds now);
  /// Processes a line of the daemon.
  void daemon_said(const nlohmann::ordered_json& line, Nanoseconds now);
  /// Call it when the connection to the daemon has ended.
  void daemon_went() noexcept;
  /// Returns the lines that must be sent to the daemon, oldest first, and removes them.
  [[nodiscard]] std::vector<nlohmann::ordered_json> lines_to_daemon();

  [[nodiscard]] const Handshake& handshake() const noexcept { return handshake_; }
  [[nodiscard]] const MasterWatch& watch() const noexcept { return watch_; }
  /// Returns true if a daemon is connected and reports its state.
  [[nodiscard]] bool hears_daemon(Nanoseconds now) const noexcept;
  /// Returns the counters of the commands to which the daemon has not responded, oldest first.
  [[nodiscard]] std::vector<std::uint16_t> unanswered() const;
  /// reacts() returns true if the reaction to a silent client was sent and has no response yet.
  /// reaction_confirms() returns true if the response to it will also cover the latest silence.
  [[nodiscard]] bool reacts() const noexcept { return reaction_.has_value(); }
  [[nodiscard]] bool reaction_confirms() const noexcept { return reaction_ && reaction_confirms_; }

 private:
  void take_counter(Master& master, Nanoseconds now);
  void execute(const Handshake::Entry& entry, Nanoseconds now);
  void notice_silence(Nanoseconds now);
  void react(Nanoseconds now);
  std::uint64_t send(nlohmann::ordered_json request);
  void show(const Master& master, Nanoseconds now);

  const Settings& settings_;
  modbus::Registers registers_;
  Masters masters_;
  Handshake handshake_;
  MasterWatch watch_;
  bool connected_ = false;
  Nanoseconds heard_at_ = 0;  // time of the last status of the daemon
  std::vector<nlohmann::ordered_json> to_daemon_;
  std::uint64_t last_id_ = 0;
  std::map<std::uint64_t, std::uint16_t> asked_;  // counters of commands, by request id
  std::optional<std::uint64_t> reaction_;         // request id of the pending reaction
  bool reaction_confirms_ = false;                // no client has fallen silent since the reaction was sent
  Nanoseconds reacted_at_ = 0;
};

}  // namespace softgrip::plc
