#pragma once
// Names the programs that can run in a simulated world together with the daemon. Counts the calls of these
// programs and the incidents during the calls.

#include <array>
#include <cstdint>

namespace softgrip::world {

enum class Tool : std::uint8_t {
  none,        ///< no additional program: the daemon and its clients run alone
  calibrate,   ///< `softgrip calibrate` with all of its procedures, called repeatedly
  doctor,      ///< `softgrip doctor --move`, called repeatedly
  run,         ///< `softgrip run`, which runs the daemon in its own process until the sequence ends
  baseline,    ///< `softgrip baseline` with one experiment, called repeatedly
  experiment,  ///< experiments one after the other, as in `softgrip investigate`
  plc,         ///< the daemon, softgrip-plc and two masters
  blocks,      ///< clients that start sequences and stop them, like the Python client
};
inline constexpr std::array tool_names{"daemon",   "calibrate",  "doctor", "run",
                                       "baseline", "experiment", "plc",    "blocks"};
inline constexpr std::size_t tool_count = tool_names.size();

/// Number of calls of a tool, and numbers of incidents during these calls.
struct Met {
  std::uint64_t calls = 0;  ///< calls of the command; for plc: commands of masters; for blocks: starts of
                            ///< sequences
  std::uint64_t results =
      0;                     ///< calls with a result; for plc: executed commands; for blocks: confirmed stops
  std::uint64_t pauses = 0;  ///< number of pauses of a thread, of the daemon, of softgrip-plc or of the clock
  /// Number of watchdog trips of the board. For plc, also includes the heartbeat time-outs of masters.
  std::uint64_t gaps = 0;
  std::uint64_t faults = 0;  ///< number of incidents of the line, the board, other clients, the fingers and
                             ///< processes

  Met& operator+=(const Met& other) noexcept {
    calls += other.calls;
    results += other.results;
    pauses += other.pauses;
    gaps += other.gaps;
    faults += other.faults;
    return *this;
  }
  /// Returns true if all counts of this structure are above 0.
  [[nodiscard]] bool whole() const noexcept {
    return calls > 0 && results > 0 && pauses > 0 && gaps > 0 && faults > 0;
  }
};

}  // namespace softgrip::world
