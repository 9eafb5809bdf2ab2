#pragma once
// The programs that run in a simulated world in addition to the daemon, and the number of incidents while
// they run.

#include <array>
#include <cstdint>

namespace softgrip::world {

enum class Tool : std::uint8_t {
  none,        ///< only the daemon and its clients
  calibrate,   ///< `softgrip calibrate` by hand, repeatedly, with all of its procedures
  doctor,      ///< `softgrip doctor --move`
  run,         ///< `softgrip run`: the daemon in the command's process, ended by its sequence
  baseline,    ///< `softgrip baseline` with one experiment
  experiment,  ///< one experiment as `softgrip investigate` plays it
  plc,         ///< softgrip-plc and two masters, with the daemon
  blocks,      ///< clients that stop the sequences that they have started, like the Python client
};
inline constexpr std::array tool_names{"daemon",   "calibrate",  "doctor", "run",
                                       "baseline", "experiment", "plc",    "blocks"};
inline constexpr std::size_t tool_count = tool_names.size();

/// Number of calls of a tool, and of disturbances during these calls.
struct Met {
  std::uint64_t calls = 0;  ///< calls of the command; for plc: commands of masters; for blocks: starts
  std::uint64_t results =
      0;                     ///< calls with a result; for plc: executed commands; for blocks: confirmed stops
  std::uint64_t pauses = 0;  ///< pauses of a thread, of the process or of the clock
  /// Trips of the board's watchdog; for plc also silences of a master.
  std::uint64_t gaps = 0;
  std::uint64_t faults = 0;  ///< incidents of line, board, other clients, fingers and processes

  Met& operator+=(const Met& other) noexcept {
    calls += other.calls;
    results += other.results;
    pauses += other.pauses;
    gaps += other.gaps;
    faults += other.faults;
    return *this;
  }
  /// Returns true if no count is 0.
  [[nodiscard]] bool whole() const noexcept {
    return calls > 0 && results > 0 && pauses > 0 && gaps > 0 && faults > 0;
  }
};

}  // namespace softgrip::world
