#include "tools/commissioning/calibration_results.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "control/feedforward/running_model.h"
#include "rig/rig_file.h"

namespace softgrip::tools::calibrate {
namespace {

constexpr double step_s = 0.01;

/// Warns if the new calibration line deviates too far from the old line at the lower or the upper limit.
void compare_lines(const std::string& what, const drivers::TwoPoints& before, const drivers::TwoPoints& now,
                   double lowest, double highest, const std::string& unit,
                   std::vector<std::string>& warnings) {
  double worst = 0;
  double at = lowest;
  for (const double value : {lowest, highest}) {
    const double off = now.y_at(before.x_at(value)) - value;
    if (std::abs(off) <= std::abs(worst)) continue;
    worst = off;
    at = value;
  }
  const double share = std::abs(worst) / (highest - lowest);
  if (!(share > most_share_off)) return;
  warnings.push_back(
      fmt::format("{}: at the point where the calibration line in the rig file gives {:.4g} {}, the new line "
                  "gives {:.4g} {}, a difference of {:.0f} % of the range",
                  what, at, unit, at + worst, unit, 100 * share));
}

/// Returns the displacement [mm] that the model predicts for free motion. The command ramps from the rest
/// pressure to `kpa` [kPa] and stays at `kpa` for the time motion.wait_s [s].
double model_mm(const control::ChannelSettings& channel, double kpa, const Motion& motion) {
  control::RunningModel model(channel.model, step_s, 0, step_s);
  double command_kpa = control::resting_kpa(channel.limits);
  model.reset(command_kpa);
  const double furthest_kpa = motion.speed_kpa_per_s * step_s;
  while (command_kpa != kpa) {
    command_kpa = std::clamp(kpa, command_kpa - furthest_kpa, command_kpa + furthest_kpa);
    model.advance(command_kpa);
  }
  for (long left = std::lround(motion.wait_s / step_s); left > 0; --left) model.advance(kpa);
  return model.reading_mm(0);
}

void compare_with_model(const control::ChannelSettings& channel, const Motion& motion, const Line& line,
                        std::vector<std::string>& warnings) {
  const double moved_mm = std::abs(line.points.y1 - line.points.y0);
  const double expected_mm =
      std::abs(model_mm(channel, motion.high_kpa, motion) - model_mm(channel, motion.low_kpa, motion));
  if (!(std::abs(moved_mm - expected_mm) > most_share_off * expected_mm)) return;
  warnings.push_back(fmt::format(
      "sensor: between {:.4g} and {:.4g} kPa the gauge reading changes by {:.4g} mm, but the "
      "model predicts {:.4g} mm, so the gauge, the calibration of the valve or the model is wrong",
      motion.low_kpa, motion.high_kpa, moved_mm, expected_mm));
}

}  // namespace

std::vector<std::string> plausibility_warnings(const rig::RigFile& rig, const Results& results) {
  const drivers::ChannelWiring& wiring = rig.wiring[results.channel];
  const control::ChannelSettings& channel = rig.settings.channels[results.channel];
  const control::LimitSettings& limits = channel.limits;
  std::vector<std::string> found;
  const auto compare_pressure = [&](const std::string& what, const drivers::TwoPoints& before,
                                    const Line& line) {
    compare_lines(what, before, line.points, limits.pressure_min_kpa, limits.pressure_max_kpa, "kPa", found);
  };
  if (results.valve) compare_pressure("valve", wiring.valve.scaling, results.valve->valve);
  if (results.valve && results.valve->monitor && wiring.pressure) {
    compare_pressure("pressure monitor", wiring.pressure->scaling, *results.valve->monitor);
  }
  if (!results.sensor) return found;
  compare_lines("sensor", wiring.displacement.scaling, results.sensor->points, limits.displacement_min_mm,
                limits.displacement_max_mm, "mm", found);
  if (results.motion) compare_with_model(channel, *results.motion, *results.sensor, found);
  return found;
}

}  // namespace softgrip::tools::calibrate
