#include "tools/investigation/experiment_rig.h"

#include <algorithm>
#include <cmath>

#include "base/numbers.h"
#include "base/statistics.h"

namespace softgrip::tools {
namespace {

/// Tolerances for duration, pressure and travel of a log, as shares of the requested values. The daemon
/// changes the command by ramps, rests and rounded corners. The tolerances exceed these changes.
constexpr double shortest_share = 0.97;
constexpr double pressure_tolerance = 0.05;
constexpr double travel_tolerance = 0.1;

struct Played {
  double length_s = 0;
  double largest_kpa = 0;
  double travel_kpa = 0;
};

Played of_log(const sysid::Log& log) {
  Played played;
  played.length_s = log.time_s.back() - log.time_s.front();
  for (std::size_t i = 0; i < log.size(); ++i) {
    played.largest_kpa = std::max(played.largest_kpa, log.pressure_command_kpa[i]);
    if (i > 0) played.travel_kpa += std::abs(log.pressure_command_kpa[i] - log.pressure_command_kpa[i - 1]);
  }
  return played;
}

Played of_waveform(const sysid::Waveform& waveform) {
  Played asked;
  const auto& corners = waveform.corners;
  asked.length_s = corners.back().time_s - corners.front().time_s;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    asked.largest_kpa = std::max(asked.largest_kpa, corners[i].pressure_kpa);
    if (i > 0) asked.travel_kpa += std::abs(corners[i].pressure_kpa - corners[i - 1].pressure_kpa);
  }
  return asked;
}

/// Returns true if the readings and predictions are sufficient to estimate the slope of a line through them.
bool is_known(const PairSums& sums) {
  return sums.count >= 10 && sums.variance_x() > 0;
}

}  // namespace

std::optional<std::string> broken_promise(const sysid::Waveform& waveform, const sysid::Log& log) {
  const Played asked = of_waveform(waveform), played = of_log(log);
  const auto differs = [](double a, double b, double share) { return std::abs(a - b) > share * b; };
  const auto sentence = [](const std::string& what, double got, double wanted, const char* unit) {
    return "the rig did not run the requested experiment: " + what + " " + significant(got, 3) +
           " instead of " + significant(wanted, 3) + " " + unit;
  };
  if (played.length_s < shortest_share * asked.length_s)
    return sentence("it took", played.length_s, asked.length_s, "s");
  if (differs(played.largest_kpa, asked.largest_kpa, pressure_tolerance))
    return sentence("the command went to", played.largest_kpa, asked.largest_kpa, "kPa");
  if (differs(played.travel_kpa, asked.travel_kpa, travel_tolerance))
    return sentence("the command changed by a total of", played.travel_kpa, asked.travel_kpa, "kPa");
  return std::nullopt;
}

std::optional<std::string> touched(const sysid::Validation& predicted, const sysid::Log& log,
                                   double known_kpa) {
  const std::vector<double>& free_mm = predicted.scores.front().prediction_mm;
  double highest_mm = 0;
  for (std::size_t i = 0; i < log.size(); ++i) {
    if (log.pressure_command_kpa[i] <= known_kpa) highest_mm = std::max(highest_mm, free_mm[i]);
  }
  PairSums lower, upper;
  double stopped_at_mm = 0, shortfall_mm = 0;
  for (std::size_t i = 0; i < log.size(); ++i) {
    const double reading_mm = log.displacement_mm[i];
    if (!std::isfinite(reading_mm) || log.pressure_command_kpa[i] > known_kpa) continue;
    if (free_mm[i] > 0.1 * highest_mm && free_mm[i] < 0.5 * highest_mm) lower.add(free_mm[i], reading_mm);
    if (free_mm[i] < 0.75 * highest_mm) continue;
    upper.add(free_mm[i], reading_mm);
    shortfall_mm = std::max(shortfall_mm, free_mm[i] - reading_mm);
    stopped_at_mm = std::max(stopped_at_mm, reading_mm);
  }
  if (!is_known(lower) || !is_known(upper)) return std::nullopt;
  // An object blocks the finger if two conditions are met. First, the slope in the upper part of the stroke
  // is below half the slope in the lower part. Second, the displacement shortfall exceeds 10 % of the stroke.
  // Without contact, a model that fits the earlier logs has smaller errors than this.
  const bool stopped = upper.slope() < 0.5 * lower.slope() && shortfall_mm > 0.1 * highest_mm;
  if (!stopped) return std::nullopt;
  return "the finger touched an object: the finger stopped at " + significant(stopped_at_mm, 3) + " mm, " +
         significant(shortfall_mm, 2) +
         " mm before its free-motion displacement. Remove the object and start again";
}

}  // namespace softgrip::tools
