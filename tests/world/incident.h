#pragma once
// The incidents of a simulated world. They form a list that is drawn from a seed, so that a test can print
// and shorten the list.

#include <cstdint>
#include <string>
#include <vector>

#include "base/time.h"

namespace softgrip::world {

struct Incident {
  enum class Kind : std::uint8_t {
    start,              ///< a client starts the sequence number `target`
    interrupted_start,  ///< a start, and immediately afterwards a stop (`value` 0) or a vent (`value` 1)
    stop,
    vent,
    release,
    acknowledge,
    flood,          ///< a client sends `target` acknowledge requests at the same time
    terminate,      ///< the daemon receives SIGTERM and is restarted one second later
    kill,           ///< the daemon receives SIGKILL
    pause,          ///< pauses one thread (`target`: Part) for `duration`
    pause_late,     ///< pauses the thread `target` for `duration`, immediately after its next reading of the
                    ///< clock
    pause_all,      ///< pauses the whole daemon process for `duration`, like SIGSTOP
    clock_stalls,   ///< the clock of the daemon stops for `duration` and then shows the true time
    line,           ///< for `duration`, every exchange ends with the status `target` (BusStatus)
    replies_lost,   ///< for `duration`, requests arrive at the board, but the responses are lost
    slow_line,      ///< for `duration`, every exchange takes `value` seconds
    write_refused,  ///< for `duration`, writes do not change the outputs of the board
    foreign,        ///< another client writes `value` kPa to all channels every 7 ms for `duration`
    sensor_stuck,   ///< the reading of channel `target` does not change for `duration`
    sensor_lost,
    line_leaks,
    part_gone,       ///< the part between the fingers is missing for `duration`
    emergency_stop,  ///< the emergency stop is pressed for `duration`
    disk_full,       ///< for `duration`, no file can grow
    // Incidents that occur only with softgrip-plc. `target` is the number of the master.
    plc_command,  ///< the master sends the command `value` (CommandCode)
    plc_silent,   ///< the program of the master stops for `duration`, and its last block is sent repeatedly
    plc_cut,      ///< the master opens a new connection; the last block arrives on the old one after
                  ///< `duration`
    plc_half,     ///< the master opens a new connection; the second half of a block arrives on the old one
                  ///< after `duration`
    gateway_paused,  ///< the gateway is paused for `duration`
    gateway_dies,    ///< the gateway process ends and is restarted one second later
    daemon_and_plc,  ///< the daemon is killed, and the master is silent for `duration`
  };
  Nanoseconds at = 0;
  Kind kind = Kind::start;
  Nanoseconds duration = 0;
  unsigned target = 0;
  double value = 0;
};

/// Returns a text that describes an incident, for example "12.345 s  pause bus for 0.612 s".
[[nodiscard]] std::string text_of(const Incident& incident);

/// Settings for drawing incidents. Incidents occur after the first second and before `length`. Pauses shorter
/// and longer than `watchdog` are drawn. If `late_bus` is true, two further kinds of incident are drawn: the
/// bus thread pauses between its last reading of the clock and its next write, and the clock stalls. The
/// daemon cannot detect these two kinds. They are drawn only if they cannot cause a late write
/// (RigShape::may_pause_late()).
struct Draw {
  std::uint64_t seed = 0;
  Nanoseconds length = 0;
  Nanoseconds watchdog = 0;
  bool late_bus = false;
  std::size_t sequences = 1;
  std::size_t channels = 1;
  bool plc = false;  ///< true: draw incidents of softgrip-plc as well
  double calm = 1;   ///< factor on the mean time between two incidents
};
[[nodiscard]] std::vector<Incident> draw_incidents(const Draw& draw);

}  // namespace softgrip::world
