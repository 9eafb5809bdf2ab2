#pragma once
// What happens to a rig in a world: drawn from a seed, a plain list, so that it can be printed and shortened.

#include <cstdint>
#include <string>
#include <vector>

#include "base/time.h"

namespace softgrip::world {

struct Incident {
  enum class Kind : std::uint8_t {
    start,  ///< a client starts a sequence; `target` says which
    hasty,  ///< the same, and at once another client stops (`value` 0) or vents
    stop,
    vent,
    release,
    acknowledge,
    flood,          ///< a client acknowledges `target` times at once
    terminate,      ///< SIGTERM; started again a second later
    kill,           ///< SIGKILL
    pause,          ///< one thread (`target`: Part) for `duration`
    pause_late,     ///< the same, right after it has looked at the clock
    pause_all,      ///< the whole process, as SIGSTOP does
    clock_stalls,   ///< shows the same for `duration`, and catches up then
    line,           ///< exchanges end as `target` (BusStatus) for `duration`
    replies_lost,   ///< requests arrive, replies do not, for `duration`
    slow_line,      ///< every exchange takes `value` s, for `duration`
    write_refused,  ///< the outputs do not follow, for `duration`
    foreign,        ///< another master writes `value` kPa to all channels every 7 ms, for `duration`
    sensor_stuck,   ///< of channel `target`, for `duration`
    sensor_lost,
    line_leaks,
    part_gone,       ///< the part is away for `duration`
    emergency_stop,  ///< pressed for `duration`
    disk_full,       ///< for `duration`
    // With softgrip-plc; `target`: the number of the master
    plc_command,     ///< it commands `value` (CommandCode)
    plc_silent,      ///< its program stops for `duration`, and its last block is written on
    plc_cut,         ///< it connects again; what it sent last arrives after `duration`
    plc_half,        ///< the same, and the first half of it has arrived
    gateway_paused,  ///< for `duration`
    gateway_dies,    ///< started again a second later
    daemon_and_plc,  ///< the daemon is killed, and the master falls silent for `duration`
  };
  Nanoseconds at = 0;
  Kind kind = Kind::start;
  Nanoseconds duration = 0;
  unsigned target = 0;
  double value = 0;
};

/// "12.345 s  pause bus for 0.612 s"
[[nodiscard]] std::string text_of(const Incident& incident);

/// Those of `length` after the first second.
/// `watchdog`: pauses are drawn around it, below, at and above. `late_bus`: the bus, too, may be paused
/// between its last look at the clock and what it then writes, and the clock may stand: only on a board that
/// says itself that its watchdog has vented, or has none, can anybody know.
struct Draw {
  std::uint64_t seed = 0;
  Nanoseconds length = 0;
  Nanoseconds watchdog = 0;
  bool late_bus = false;
  std::size_t sequences = 1;
  std::size_t channels = 1;
  bool plc = false;  ///< softgrip-plc runs
  double calm = 1;   ///< factor of the mean time between two incidents
};
[[nodiscard]] std::vector<Incident> draw_incidents(const Draw& draw);

}  // namespace softgrip::world
