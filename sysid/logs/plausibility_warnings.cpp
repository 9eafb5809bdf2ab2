#include "sysid/logs/plausibility_warnings.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "base/numbers.h"
#include "base/statistics.h"
#include "model/port_flow.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/command_range.h"
#include "sysid/logs/finite_values.h"
#include "sysid/logs/isolated_values.h"
#include "sysid/logs/unit_factors.h"

namespace softgrip::sysid {
namespace {

using model::atmosphere_kpa;

// Limits for plausible values. A value beyond a limit in this file or in unit_factors.h probably has a wrong
// unit.
constexpr double large_pressure_kpa = 1000;
/// If the pressure of a soft finger is in MPa, its largest value is below this limit.
constexpr double small_as_mpa = 0.2;
/// The pressure is probably in psi if its largest value is below this limit and the gain exceeds
/// large_gain_mm_per_kpa or large_gain_deg_per_kpa.
constexpr double small_as_psi = 20;
constexpr double large_gain_mm_per_kpa = 1;
constexpr double large_gain_deg_per_kpa = 5;
constexpr double small_as_mbar = 20e3;
constexpr double large_displacement_mm = 500;
constexpr double slow_sampling_s = 1;
/// Limit of the mean relative area of the loops. An area below this negative limit means that the readings
/// precede the pressure by more than a drift of the sensor can explain.
constexpr double clear_loop_backwards = -0.02;

PairSums sums_of(const std::vector<double>& x, const std::vector<double>& y) {
  PairSums sums;
  for (std::size_t i = 0; i < x.size() && i < y.size(); ++i) sums.add(x[i], y[i]);
  return sums;
}

/// Returns the lag [samples] at which the increments of `later` correlate best with the increments of
/// `earlier`. The lag is negative if `later` changes first. Returns 0 if no correlation is significant.
int best_lag(const std::vector<double>& earlier, const std::vector<double>& later) {
  constexpr int farthest = 20;
  const auto increments = [](const std::vector<double>& values) {
    std::vector<double> steps(values.size(), 0);
    for (std::size_t i = 1; i < values.size(); ++i) steps[i] = values[i] - values[i - 1];
    return steps;
  };
  const std::vector<double> a = increments(earlier);
  const std::vector<double> b = increments(later);
  double best = 0;
  int lag = 0;
  for (int shift = -farthest; shift <= farthest; ++shift) {
    PairSums sums;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const auto at = static_cast<std::ptrdiff_t>(i) + shift;
      if (at >= 0 && at < static_cast<std::ptrdiff_t>(b.size()))
        sums.add(a[i], b[static_cast<std::size_t>(at)]);
    }
    if (sums.correlation() <= best) continue;
    best = sums.correlation();
    lag = shift;
  }
  return best > limits::clear_correlation ? lag : 0;
}

void check_measured_pressure(const Log& log, std::vector<std::string>& warnings) {
  if (log.pressure_kpa.empty() || log.pressure_kpa == log.pressure_command_kpa) return;
  const PairSums sums = sums_of(log.pressure_command_kpa, log.pressure_kpa);
  if (sums.correlation() < -limits::clear_correlation) {
    warnings.push_back("the measured pressure decreases when the command increases (correlation " +
                       significant(sums.correlation(), 3) +
                       "). If the sign is wrong, use `softgrip import --scale pressure=-X`");
    return;
  }
  if (sums.correlation() < limits::clear_correlation) return;
  const double slope = sums.slope();
  if (const std::string units = pressure_units_apart(slope); !units.empty())
    warnings.push_back(
        "the measured pressure is " + significant(slope, 3) +
        " times the command, which is the conversion factor between " + units +
        ". If the unit of one column is wrong, state the right unit with `softgrip import --unit`");
  constexpr int clearly_before = -2;
  if (best_lag(log.pressure_command_kpa, log.pressure_kpa) <= clearly_before)
    warnings.emplace_back(
        "the measured pressure changes before its command, so the two columns may be swapped");
}

const std::vector<double>& drive_of(const Log& log) {
  return log.pressure_kpa.empty() ? log.pressure_command_kpa : log.pressure_kpa;
}

/// Returns the mean area of the loops in a plot of the readings over the pressure, divided by the area of the
/// bounding rectangle of the plot. The travel of the pressure determines the number of loops. The result is
/// positive if the readings lag behind the pressure, as in every dissipative system.
double loop_share(const std::vector<double>& pressure, const std::vector<double>& reading) {
  const auto p = extent_of(pressure), y = extent_of(reading);
  if (!p || !y || p->width() <= 0 || y->width() <= 0) return 0;
  double area = 0, travel = 0;
  std::optional<std::size_t> before;
  for (std::size_t i = 0; i < pressure.size(); ++i) {
    if (!std::isfinite(pressure[i]) || !std::isfinite(reading[i])) continue;
    if (before) {
      area += (0.5 * (pressure[i] + pressure[*before]) - p->lowest) * (reading[i] - reading[*before]);
      travel += std::abs(pressure[i] - pressure[*before]);
    }
    before = i;
  }
  const double loops = std::max(1.0, travel / (2 * p->width()));
  return area / (p->width() * y->width() * loops);
}

void check_response(const Log& log, ReadingSign sign, std::vector<std::string>& warnings) {
  const std::vector<double>& drive = drive_of(log);
  const double correlation = sums_of(drive, log.displacement_mm).correlation();
  if (correlation < -limits::clear_correlation) {
    const std::string found =
        "the reading decreases when the pressure increases (correlation " + significant(correlation, 3) + ")";
    const std::string unit =
        log.output_unit == model::OutputUnit::deg ? " and --unit displacement=deg" : std::string();
    warnings.push_back(sign == ReadingSign::reversed
                           ? found +
                                 ", and the factor of `--scale displacement` is negative. Use "
                                 "the opposite sign"
                           : found +
                                 ". If the sensor is mounted in reverse, use `softgrip import --scale "
                                 "displacement=-X` with a negative factor" +
                                 unit);
    return;
  }
  const double share = loop_share(drive, log.displacement_mm);
  if (correlation > limits::clear_correlation && share < clear_loop_backwards)
    warnings.push_back(
        "the reading changes before the pressure (the hysteresis loops run backwards and enclose " +
        significant(-100 * share, 2) +
        " % of their bounding rectangle), so the columns of pressure and displacement may be swapped");
}

void check_single_commands(const Log& log, std::vector<std::string>& warnings) {
  if (log.size() == 0) return;
  const CommandRange range = command_range(log.pressure_command_kpa);
  if (range.excursions.empty()) return;
  const bool is_one = range.excursions.size() == 1;
  warnings.push_back(std::to_string(range.excursions.size()) +
                     (is_one ? " single sample has a command" : " single samples have commands") +
                     " outside the range of all other samples (" + significant(range.lowest_kpa, 3) + " to " +
                     significant(range.highest_kpa, 3) + " kPa): " +
                     sysid::listed(log.pressure_command_kpa, log.time_s, range.excursions, "kPa") +
                     ". softgrip uses these values. If a value is wrong, use `softgrip import --missing-in "
                     "COLUMN=X`, which replaces X by the previous command");
}

void check_free_motion(const Log& log, std::vector<std::string>& warnings) {
  const auto result = std::find_if(log.others.begin(), log.others.end(),
                                   [](const OtherColumn& column) { return column.name == "result"; });
  if (result == log.others.end()) return;
  const auto holding = std::count(result->cells.begin(), result->cells.end(), "holding");
  if (holding == 0) return;
  warnings.push_back("the finger holds a part in " +
                     significant(100 * static_cast<double>(holding) / static_cast<double>(log.size()), 2) +
                     " % of the rows (column result). A model of free motion cannot be fitted to or tested "
                     "with these rows. Record a run without contact");
}

/// Returns a sentence with the option and the header of a column that state its unit. The sentence begins
/// with the full stop of the sentence before it.
std::string state_unit(const std::string& role, const std::string& unit) {
  return ". State the unit of this column: `softgrip import --unit " + role + "=" + unit + "`, or `(" + unit +
         ")` in the header of the column";
}

/// Returns a text about a column: its name, its largest value, and the option that states the probable unit.
std::string state_unit(const PressureColumn& column, const ColumnExtent& p, const char* unit) {
  const double largest = -p.lowest > p.highest ? p.lowest : p.highest;
  return ". The largest value of `" + column.name + "` is " + significant(largest, 3) +
         state_unit(column.role, unit);
}

void judge_unit_of_pressure(const Log& log, const PressureColumn& column,
                            std::vector<std::string>& warnings) {
  const auto p = extent_of(log.pressure_command_kpa);
  if (!p || p->width() <= 0) return;
  const auto y = extent_of(log.displacement_mm);
  const double largest = std::max(-p->lowest, p->highest);
  const double large_gain =
      log.output_unit == model::OutputUnit::deg ? large_gain_deg_per_kpa : large_gain_mm_per_kpa;
  if (largest < small_as_mpa) {
    warnings.push_back("the pressure stays below " + significant(small_pressure_kpa) +
                       " kPa: check if the values are in MPa, bar or V instead of kPa" +
                       state_unit(column, *p, "MPa"));
  } else if (largest < small_pressure_kpa) {
    warnings.push_back("the pressure stays below " + significant(small_pressure_kpa) +
                       " kPa: check if the values are in bar or V instead of kPa" +
                       state_unit(column, *p, "bar"));
  } else if (largest < small_as_psi && y && y->width() > large_gain * p->width()) {
    warnings.push_back(
        "the pressure stays below " + significant(small_as_psi) + " kPa, and the finger moves by " +
        model::in_unit(significant(y->width() / p->width(), 3) + " mm", log.output_unit) +
        " per kPa: check if the values are in psi instead of kPa" + state_unit(column, *p, "psi"));
  } else if (largest > large_pressure_kpa) {
    warnings.push_back(
        "the pressure reaches " + significant(largest) +
        " kPa, which no soft finger withstands: check if the values are in Pa or mbar instead of kPa" +
        state_unit(column, *p, largest < small_as_mbar ? "mbar" : "Pa"));
  }
}

void check_spans(const Log& log, std::vector<std::string>& warnings) {
  using model::OutputUnit;
  const OutputUnit unit = log.output_unit;
  if (const auto p = extent_of(log.pressure_command_kpa); p && p->width() > 0) {
    if (p->lowest > 0.9 * atmosphere_kpa && p->lowest < 1.1 * atmosphere_kpa)
      warnings.push_back("the pressure never falls below " + significant(p->lowest) +
                         " kPa, about 1 atmosphere. If the pressure is absolute, subtract the atmosphere "
                         "with `softgrip import --zero`");
  }
  if (const auto y = extent_of(log.displacement_mm); y && y->width() > 0) {
    if (y->width() < small_reading(unit))
      warnings.push_back(model::in_unit("the displacement spans ", unit) + significant(y->width()) +
                         (unit == OutputUnit::deg
                              ? " deg: check if the values are in radians or V instead of deg"
                              : " mm: check if the values are in metres or V instead of mm") +
                         state_unit("displacement", unit == OutputUnit::deg ? "rad" : "m"));
    if (y->width() > large_displacement_mm)
      warnings.push_back(model::in_unit("the displacement spans ", unit) + significant(y->width()) +
                         (unit == OutputUnit::deg
                              ? " deg: check if the values are in counts or degrees instead of radians"
                              : " mm: check if the values are in micrometres instead of mm") +
                         state_unit("displacement", unit == OutputUnit::deg ? "deg" : "um"));
  }
  if (const auto t = extent_of(log.temperature_c); t && t->lowest > 200)
    warnings.push_back("the temperature is above 200 C: check if the values are in kelvin" +
                       state_unit("temperature", "K"));
}

}  // namespace

std::vector<std::string> plausibility_warnings(const Log& log, const PressureColumn& column,
                                               ReadingSign sign) {
  std::vector<std::string> warnings;
  check_response(log, sign, warnings);
  check_single_commands(log, warnings);
  check_free_motion(log, warnings);
  check_measured_pressure(log, warnings);
  judge_unit_of_pressure(log, column, warnings);
  check_spans(log, warnings);
  if (log.size() > 1) {
    const double interval = sampling_of(log).median_interval_s;
    if (interval > slow_sampling_s)
      warnings.push_back("samples are " + significant(interval) +
                         " s apart: check if the times are in ms instead of s" + state_unit("time", "ms"));
    if (interval < 1e-5)
      warnings.push_back("samples are " + significant(interval) +
                         " s apart: check if the times are in h or d instead of s" + state_unit("time", "h"));
  }
  return warnings;
}

namespace {

/// Returns true if the values of the log show a wrong unit, without a comparison with other logs.
bool shows_wrong_unit(const Log& log) {
  std::vector<std::string> warnings;
  judge_unit_of_pressure(log, {}, warnings);
  check_spans(log, warnings);
  return !warnings.empty();
}

bool same_samples(const Log& a, const Log& b) {
  const auto same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  return std::ranges::equal(a.displacement_mm, b.displacement_mm, same) &&
         std::ranges::equal(drive_of(a), drive_of(b), same);
}

/// Appends a warning if `log` has the same samples as one of the logs in `earlier`.
void warn_of_repetition(const Log& log, std::span<const Log> earlier, const std::string& kind,
                        std::string_view repeated, std::vector<std::string>& warnings) {
  const auto first =
      std::ranges::find_if(earlier, [&](const Log& other) { return same_samples(other, log); });
  if (first == earlier.end()) return;
  warnings.push_back(log.name + ": the log contains the same samples as " + kind + first->name + ". " +
                     std::string(repeated));
}

}  // namespace

std::vector<std::string> repetition_warnings(const std::vector<Log>& logs, const std::vector<Log>& earlier,
                                             const std::string& kind, std::string_view repeated) {
  std::vector<std::string> warnings;
  for (const Log& log : logs) warn_of_repetition(log, earlier, kind + " ", repeated, warnings);
  return warnings;
}

std::vector<std::string> corrections_of(const std::vector<Log>& logs) {
  std::vector<std::string> sentences;
  for (const Log& log : logs) {
    for (const LogNote& note : log.notes) {
      if (note.corrects) sentences.push_back(log.name + ": " + note.text);
    }
  }
  return sentences;
}

std::vector<std::string> plausibility_warnings_among(const std::vector<Log>& logs,
                                                     std::string_view repeated) {
  std::vector<std::string> warnings = corrections_of(logs);
  std::vector<double> gains;
  std::vector<double> usual_gains;
  for (const Log& log : logs) {
    for (const std::string& warning : plausibility_warnings(log))
      warnings.push_back(logs.size() > 1 ? log.name + ": " + warning : warning);
    const PairSums sums = sums_of(drive_of(log), log.displacement_mm);
    gains.push_back(sums.correlation() > limits::clear_correlation ? sums.slope() : 0);
    if (gains.back() != 0 && !shows_wrong_unit(log)) usual_gains.push_back(gains.back());
  }
  for (std::size_t i = 1; i < logs.size(); ++i)
    warn_of_repetition(logs[i], std::span(logs).first(i), "", repeated, warnings);
  // A log whose own values show a wrong unit must not cause a warning about the other logs.
  if (usual_gains.empty()) return warnings;
  const double usual = median_of(std::span(usual_gains));
  for (std::size_t i = 0; i < logs.size(); ++i) {
    if (gains[i] <= 0) continue;
    if (const std::string mistake = mistaken_unit(gains[i] / usual, logs[i].output_unit); !mistake.empty())
      warnings.push_back(logs[i].name + ": the finger moves " + significant(gains[i] / usual, 3) +
                         " times as far per kPa as in the other logs. Possible cause: " + mistake + "?");
  }
  return warnings;
}

std::string scale_warning(const std::string& log_name, const std::vector<double>& prediction_mm,
                          const std::vector<double>& reading_mm, model::OutputUnit unit) {
  const PairSums sums = sums_of(prediction_mm, reading_mm);
  if (sums.correlation() < limits::clear_correlation) return {};
  // Fingers of one design differ less than this.
  constexpr double implausible = 3;
  const double factor = sums.slope();
  const std::string found =
      log_name + ": the readings are " + significant(factor, 3) + " times the prediction of the model. ";
  const std::string mistake = mistaken_unit(factor, unit);
  if (!mistake.empty()) return found + "Possible cause: " + mistake + "?";
  if (std::abs(std::log(std::abs(factor))) < std::log(implausible)) return {};
  return found + "Check if the log and the model belong to the same finger, and check the units";
}

}  // namespace softgrip::sysid
