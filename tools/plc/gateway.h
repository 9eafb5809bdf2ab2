#pragma once
// Registers on one side, the daemon's lines on the other. No sockets and no clock: who owns those hands in
// what arrived and the time, and sends what goes out.

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
  /// `settings` outlives it.
  explicit Gateway(const Settings& settings);

  /// Who is connected. Connections come and go here; one that has no place any more is to be closed.
  [[nodiscard]] Masters& masters() noexcept { return masters_; }
  [[nodiscard]] const Masters& masters() const noexcept { return masters_; }
  /// Answers a master that has a place, and passes its command on to the daemon.
  [[nodiscard]] modbus::Reply serve(Masters::Id id, const modbus::Request& request, Nanoseconds now);
  /// To be called after the daemon's lines, and every `longest_pause`: commands that waited, silences.
  void look_after(Nanoseconds now);
  static constexpr Nanoseconds longest_pause = 20'000'000;

  /// The connection with the daemon is open.
  void daemon_came(Nanoseconds now);
  /// A line of the daemon.
  void daemon_said(const nlohmann::ordered_json& line, Nanoseconds now);
  /// The connection with the daemon has ended.
  void daemon_went() noexcept;
  /// Returns the lines that go to the daemon, the oldest first, and forgets them.
  [[nodiscard]] std::vector<nlohmann::ordered_json> lines_to_daemon();

  [[nodiscard]] const Handshake& handshake() const noexcept { return handshake_; }
  [[nodiscard]] const MasterWatch& watch() const noexcept { return watch_; }
  /// A daemon is connected and reports its state.
  [[nodiscard]] bool hears_daemon(Nanoseconds now) const noexcept;
  /// Counters of the commands that the daemon has not answered, the oldest first.
  [[nodiscard]] std::vector<std::uint16_t> unanswered() const;
  /// The reaction to a silence is on its way to the daemon, and whether its answer confirms all silences.
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
  Nanoseconds heard_at_ = 0;  // a state of the daemon
  std::vector<nlohmann::ordered_json> to_daemon_;
  std::uint64_t last_id_ = 0;
  std::map<std::uint64_t, std::uint16_t> asked_;  // counters of commands by the ids of their requests
  std::optional<std::uint64_t> reaction_;         // the id of its request
  bool reaction_confirms_ = false;                // no silence has begun since it was sent
  Nanoseconds reacted_at_ = 0;
};

}  // namespace softgrip::plc
