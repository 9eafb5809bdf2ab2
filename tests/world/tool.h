#pragma once
// The programs around the daemon that a world may contain, and what they meet there.

#include <array>
#include <cstdint>

namespace softgrip::world {

enum class Tool : std::uint8_t {
  none,        ///< the daemon and its clients alone
  calibrate,   ///< by hand, again and again; all of its procedures
  doctor,      ///< with --move
  run,         ///< `softgrip run`: the daemon in its own process, ended by its sequence
  baseline,    ///< of one experiment
  experiment,  ///< as `softgrip investigate` plays one
  plc,         ///< softgrip-plc and two masters, with the daemon
  blocks,      ///< clients that stop what they have started, as the Python client does
};
inline constexpr std::array tool_names{"daemon",   "calibrate",  "doctor", "run",
                                       "baseline", "experiment", "plc",    "blocks"};
inline constexpr std::size_t tool_count = tool_names.size();

/// How often a tool was used, and how often the world came in its way meanwhile.
struct Met {
  std::uint64_t calls = 0;  ///< of the command; of softgrip-plc: commands of masters; of blocks: starts
  std::uint64_t results =
      0;  ///< that ended well; of softgrip-plc: commands that were executed; of blocks: left
  std::uint64_t pauses = 0;  ///< of one thread, of the process or of the clock
  /// Times in which the board's watchdog vented; of softgrip-plc: of a master's silence, too.
  std::uint64_t gaps = 0;
  std::uint64_t faults = 0;  ///< of line, board, second masters, fingers, processes

  Met& operator+=(const Met& other) noexcept {
    calls += other.calls;
    results += other.results;
    pauses += other.pauses;
    gaps += other.gaps;
    faults += other.faults;
    return *this;
  }
  /// Nothing of it is 0.
  [[nodiscard]] bool whole() const noexcept {
    return calls > 0 && results > 0 && pauses > 0 && gaps > 0 && faults > 0;
  }
};

}  // namespace softgrip::world
