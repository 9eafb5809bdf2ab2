#pragma once
// Converts between registers and lines of the daemon. It has no sockets and no clock: its owner passes the
// received data and the time, and sends the results.

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

  /// The connected clients (Modbus masters). Connections are added and removed here. Close a connection that
  /// has lost its place.
  [[nodiscard]] Masters& masters() noexcept { return masters_; }
  [[nodiscard]] const Masters& masters() const noexcept { return masters_; }
  /// Responds to a client that has a place, and passes its command to the daemon.
  [[nodiscard]] modbus::Reply serve(Masters::Id id, const modbus::Request& request, Nanoseconds now);
  /// Processes waiting commands and silences. Call it after the daemon's lines and every `longest_pause`.
  void look_after(Nanoseconds now);
  static constexpr Nanoseconds longest_pause = 20'000'000;

  /// The connection to the daemon was opened.
  void daemon_came(Nanoseconds now);
  /// Processes a line of the daemon.
  void daemon_said(const nlohmann::ordered_json& line, Nanoseconds now);
  /// The connection to the daemon has ended.
  void daemon_went() noexcept;
  /// Returns the lines to the daemon, oldest first, and removes them.
  [[nodiscard]] std::vector<nlohmann::ordered_json> lines_to_daemon();

  [[nodiscard]] const Handshake& handshake() const noexcept { return handshake_; }
  [[nodiscard]] const MasterWatch& watch() const noexcept { return watch_; }
  /// Returns true if a daemon is connected and reports its state.
  [[nodiscard]] bool hears_daemon(Nanoseconds now) const noexcept;
  /// Returns the counters of the commands without a response of the daemon, oldest first.
  [[nodiscard]] std::vector<std::uint16_t> unanswered() const;
  /// Returns true if the reaction to a silence was sent and has no response yet. reaction_confirms(): its
  /// response will confirm all silences so far.
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
  Nanoseconds heard_at_ = 0;  // last state of the daemon
  std::vector<nlohmann::ordered_json> to_daemon_;
  std::uint64_t last_id_ = 0;
  std::map<std::uint64_t, std::uint16_t> asked_;  // counters of commands, by request id
  std::optional<std::uint64_t> reaction_;         // request id of the pending reaction
  bool reaction_confirms_ = false;                // no new silence has begun since the reaction was sent
  Nanoseconds reacted_at_ = 0;
};

}  // namespace softgrip::plc
