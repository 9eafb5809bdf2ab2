#include "tests/world/rig_shape.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "base/random.h"

namespace softgrip::world {

RigShape draw_shape(const rig::RigFile& example, std::uint64_t seed) {
  RigShape shape;
  shape.rig = example;
  shape.seed = seed;
  std::uint64_t drawn = 0;
  const auto one_of = [&](auto... values) {
    const std::array all{values...};
    return all[static_cast<std::size_t>(uniform_at(derived_seed(seed, 3), ++drawn) *
                                        static_cast<double>(all.size()))];
  };
  control::RigSettings& settings = shape.rig.settings;
  const double watchdog_s = one_of(0.0, 0.2, 0.5, 0.5, 1.0);
  shape.watchdog = nanoseconds(watchdog_s);
  shape.trip_latches = one_of(true, false);
  settings.safety.board_vents_when_silent = shape.watchdog > 0;
  settings.safety.safe_action[static_cast<std::size_t>(control::Phase::holding)] =
      one_of(control::SafeAction::hold, control::SafeAction::vent);
  settings.safety.on_emergency_stop =
      one_of(control::SafeAction::vent, control::SafeAction::vent, control::SafeAction::hold);
  // Largest permitted delay of the bus fault [cycles]. With a larger delay, the watchdog of the board could
  // trip before the daemon latches the fault.
  const double most_cycles = watchdog_s > 0 ? 0.8 * watchdog_s * settings.rate_hz : 200;
  settings.faults.bus_down_cycles =
      static_cast<std::uint32_t>(std::clamp(one_of(2.0, 5.0, 30.0, most_cycles), 1.0, most_cycles));
  settings.faults.invalid_reading_cycles = static_cast<std::uint32_t>(one_of(3, 5, 400));
  settings.faults.readback_cycles = static_cast<std::uint32_t>(one_of(5, 10));
  settings.faults.overrun_cycles = static_cast<std::uint32_t>(one_of(0, 0, 50));
  settings.faults.pressure_cycles = static_cast<std::uint32_t>(one_of(0, 20));
  shape.rig.loop.max_missed_commands = static_cast<std::uint32_t>(one_of(5, 10, 40));
  const double slew = one_of(15.0, 60.0, 300.0);
  for (control::ChannelSettings& channel : settings.channels) {
    channel.limits.slew_up_kpa_per_s = slew;
    channel.limits.slew_down_kpa_per_s = 2 * slew;
  }
  shape.text = fmt::format(
      "watchdog {} s{}, bus_down_cycles {}, max_missed_commands {}, slew {}/{} kPa/s, holding: {}, "
      "on_emergency_stop: {}",
      watchdog_s, shape.trip_latches ? ", latching" : ", cleared by a write", settings.faults.bus_down_cycles,
      shape.rig.loop.max_missed_commands, slew, 2 * slew,
      control::name_of(settings.safety.safe_action[static_cast<std::size_t>(control::Phase::holding)]),
      control::name_of(settings.safety.on_emergency_stop));
  const control::LimitSettings& limits = settings.channels.front().limits;
  const double rest_kpa = control::resting_kpa(limits);
  if (rest_kpa > limits.pressure_min_kpa)
    shape.text +=
        fmt::format(", {} to {} kPa, rest {}", limits.pressure_min_kpa, limits.pressure_max_kpa, rest_kpa);
  return shape;
}

void draw_habits(RigShape& shape, bool always) {
  constexpr std::uint64_t one_in = 5;
  if (!always && shape.seed % one_in != 0) return;
  std::uint64_t drawn = 0;
  const auto one_of = [&](auto... values) {
    const std::array all{values...};
    return all[static_cast<std::size_t>(uniform_at(derived_seed(shape.seed, 11), ++drawn) *
                                        static_cast<double>(all.size()))];
  };
  Habits& habits = shape.habits;
  const double deaf_s = one_of(0.0, 0.05, 0.15, 0.4);
  habits.deaf = nanoseconds(deaf_s);
  // One of 4 boards gets a `settle_s` of 0 in the rig file.
  habits.settle = nanoseconds(one_of(1.0, 1.0, 1.0, 0.0) * (deaf_s + 0.02));
  habits.repeat_after = nanoseconds(one_of(0.0, 0.2, 0.4) * shape.rig.loop.exchange_deadline_s);
  habits.channels_at_once = static_cast<std::size_t>(one_of(0, 1));
  habits.closes_every = static_cast<unsigned>(one_of(0, 2, 5));
  habits.loses_every = static_cast<unsigned>(one_of(0, 7, 50, 400));
  habits.spoils_every = static_cast<unsigned>(one_of(0, 60, 500));
  habits.reads_apart = one_of(false, true);
  shape.text += fmt::format(
      ", the board ignores requests for {} s after a connection, settle_s {:.2f}, repeat_after_s {:.3f}, {} "
      "channels per request (0: all), the board closes every Nth connection (N = {}), every Nth response is "
      "lost "
      "(N = {}), stray bytes arrive before every Nth response (N = {}; N = 0: never){}",
      deaf_s, seconds(habits.settle), seconds(habits.repeat_after), habits.channels_at_once,
      habits.closes_every, habits.loses_every, habits.spoils_every,
      habits.reads_apart ? ", separate requests to write and to read" : "");
}

}  // namespace softgrip::world
