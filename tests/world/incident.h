#pragma once
// The incidents of a simulated world. They are a plain list that is drawn from a seed, so that it can be
// printed and shortened.

#include <cstdint>
#include <string>
#include <vector>

#include "base/time.h"

namespace softgrip::world {

struct Incident {
  enum class Kind : std::uint8_t {
    start,  ///< a client starts the sequence number `target`
    hasty,  ///< a start, which another client stops (`value` 0) or vents immediately
    stop,
    vent,
    release,
    acknowledge,
    flood,          ///< a client sends `target` acknowledgements at once
    terminate,      ///< SIGTERM; the daemon is started again one second later
    kill,           ///< SIGKILL
    pause,          ///< pauses one thread (`target`: Part) for `duration`
    pause_late,     ///< pauses the thread right after its next reading of the clock
    pause_all,      ///< pauses the whole process, like SIGSTOP
    clock_stalls,   ///< the clock stands still for `duration` and then catches up
    line,           ///< exchanges end with status `target` (BusStatus) for `duration`
    replies_lost,   ///< requests arrive and responses are lost for `duration`
    slow_line,      ///< every exchange takes `value` s for `duration`
    write_refused,  ///< the outputs do not follow writes for `duration`
    foreign,        ///< another client writes `value` kPa to all channels every 7 ms for `duration`
    sensor_stuck,   ///< the sensor of channel `target` is stuck for `duration`
    sensor_lost,
    line_leaks,
    part_gone,       ///< the part is removed for `duration`
    emergency_stop,  ///< the emergency stop is pressed for `duration`
    disk_full,       ///< no file can grow for `duration`
    // With softgrip-plc; `target`: number of the master.
    plc_command,  ///< the master sends the command `value` (CommandCode)
    plc_silent,   ///< the program of the master stops for `duration`, while its last block is repeated
    plc_cut,   ///< the master opens a new connection; its last block arrives on the old one after `duration`
    plc_half,  ///< like plc_cut, after the first half of the block has arrived
    gateway_paused,  ///< the gateway is paused for `duration`
    gateway_dies,    ///< the gateway is started again one second later
    daemon_and_plc,  ///< the daemon is killed, and the master is silent for `duration`
  };
  Nanoseconds at = 0;
  Kind kind = Kind::start;
  Nanoseconds duration = 0;
  unsigned target = 0;
  double value = 0;
};

/// Returns a text such as "12.345 s  pause bus for 0.612 s".
[[nodiscard]] std::string text_of(const Incident& incident);

/// Parameters of the incidents, which occur after the first second within `length`. `watchdog`: pauses are
/// drawn below and above this time. `late_bus`: the bus thread may also be paused between its last reading of
/// the clock and its next write, and the clock may stall. A daemon notices such a delay only if the board
/// reports its own watchdog trip or has no watchdog.
struct Draw {
  std::uint64_t seed = 0;
  Nanoseconds length = 0;
  Nanoseconds watchdog = 0;
  bool late_bus = false;
  std::size_t sequences = 1;
  std::size_t channels = 1;
  bool plc = false;  ///< true: softgrip-plc runs
  double calm = 1;   ///< factor of the mean time between two incidents
};
[[nodiscard]] std::vector<Incident> draw_incidents(const Draw& draw);

}  // namespace softgrip::world
