#pragma once
// The daemon on one side, registers on the other.

#include <cstdint>
#include <map>
#include <optional>

#include <nlohmann/json_fwd.hpp>

#include "base/time.h"
#include "drivers/modbus_server/registers.h"
#include "drivers/modbus_server/reply.h"
#include "rig/plc_file/settings.h"
#include "tools/client/daemon_client.h"
#include "tools/plc/handshake.h"
#include "tools/plc/master_watch.h"

namespace softgrip::plc {

class Gateway {
 public:
  /// `settings` outlives it.
  explicit Gateway(const Settings& settings);

  /// Answers a master, and sends on what it commands.
  [[nodiscard]] modbus::Reply serve(const modbus::Request& request, Nanoseconds now);
  /// To be called when the daemon's descriptor can be read, and every `longest_pause`: the daemon's lines,
  /// heartbeats, connecting anew.
  void look_after(Nanoseconds now);
  static constexpr Nanoseconds longest_pause = 20'000'000;

  /// Of the connection with the daemon; -1 if there is none.
  [[nodiscard]] int descriptor() const noexcept { return daemon_ ? daemon_->descriptor() : -1; }
  /// The master beats, or has never begun to.
  [[nodiscard]] bool hears_master(Nanoseconds now) const noexcept { return !watch_.silent(now); }

 private:
  void connect(Nanoseconds now);
  void lose() noexcept;
  void take(const nlohmann::ordered_json& line, Nanoseconds now);
  void command(Nanoseconds now);
  void react(Nanoseconds now);
  void send(nlohmann::ordered_json request, std::optional<std::uint16_t> counter);
  void show(Nanoseconds now);

  const Settings& settings_;
  modbus::Registers registers_;
  Handshake handshake_;
  MasterWatch watch_;
  std::optional<tools::DaemonClient> daemon_;
  Nanoseconds tried_at_ = 0;  // to connect
  Nanoseconds heard_at_ = 0;  // a state of the daemon
  std::uint64_t last_id_ = 0;
  std::map<std::uint64_t, std::uint16_t> asked_;  // counters of commands by the ids of their requests
};

}  // namespace softgrip::plc
