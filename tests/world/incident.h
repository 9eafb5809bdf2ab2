#pragma once
// The incidents of a simulated world. They form a plain list that is drawn from a seed, so that the list can
// be printed and shortened.

#include <cstdint>
#include <string>
#include <vector>

#include "base/time.h"

namespace softgrip::world {

struct Incident {
  enum class Kind : std::uint8_t {
    start,              ///< a client starts the sequence number `target`
    interrupted_start,  ///< a start, which another client stops (`value` 0) or vents immediately
    stop,
    vent,
    release,
    acknowledge,
    flood,          ///< a client sends `target` requests to acknowledge faults at once
    terminate,      ///< the daemon receives SIGTERM and is started again one second later
    kill,           ///< the daemon receives SIGKILL
    pause,          ///< pauses one thread (`target`: Part) for `duration`
    pause_late,     ///< pauses the thread immediately after its next reading of the clock
    pause_all,      ///< pauses the whole daemon process for `duration`, like SIGSTOP
    clock_stalls,   ///< the daemon's clock stands still for `duration` and then shows the true time
    line,           ///< for `duration`, every exchange ends with the status `target` (BusStatus)
    replies_lost,   ///< for `duration`, requests arrive at the board, but its responses are lost
    slow_line,      ///< for `duration`, every exchange takes `value` seconds
    write_refused,  ///< for `duration`, the outputs of the board do not follow writes
    foreign,        ///< another client writes `value` kPa to all channels every 7 ms for `duration`
    sensor_stuck,   ///< the reading of channel `target` does not change for `duration`
    sensor_lost,
    line_leaks,
    part_gone,       ///< the part that a finger grips is removed for `duration`
    emergency_stop,  ///< the emergency stop is pressed for `duration`
    disk_full,       ///< for `duration`, no file can grow
    // The following incidents occur with softgrip-plc. `target` is the number of the master.
    plc_command,  ///< the master sends the command `value` (CommandCode)
    plc_silent,   ///< the program of the master stops for `duration`, but its last block is sent repeatedly
    plc_cut,      ///< the master opens a new connection; its last block arrives on the old connection after
                  ///< `duration`
    plc_half,     ///< the second half of a block arrives on the old connection after `duration`, while the
                  ///< master has opened a new connection
    gateway_paused,  ///< the gateway is paused for `duration`
    gateway_dies,    ///< the gateway process ends and is started again one second later
    daemon_and_plc,  ///< the daemon is killed, and the master is silent for `duration`
  };
  Nanoseconds at = 0;
  Kind kind = Kind::start;
  Nanoseconds duration = 0;
  unsigned target = 0;
  double value = 0;
};

/// Returns an incident as text, for example "12.345 s  pause bus for 0.612 s".
[[nodiscard]] std::string text_of(const Incident& incident);

/// Settings with which incidents are drawn. Incidents occur after the first second, within `length`.
/// `watchdog`: pauses shorter and longer than this time are drawn. `late_bus`: two further kinds of incident
/// are drawn, which a daemon notices only if the board reports its own watchdog trip or has no watchdog. In
/// the first, the bus thread pauses between its last reading of the clock and its next write. In the second,
/// the clock stalls.
struct Draw {
  std::uint64_t seed = 0;
  Nanoseconds length = 0;
  Nanoseconds watchdog = 0;
  bool late_bus = false;
  std::size_t sequences = 1;
  std::size_t channels = 1;
  bool plc = false;  ///< true: incidents of softgrip-plc are drawn
  double calm = 1;   ///< factor by which the mean time between two incidents is multiplied
};
[[nodiscard]] std::vector<Incident> draw_incidents(const Draw& draw);

}  // namespace softgrip::world
