#include "sysid/logs/log_header.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "base/numbers.h"
#include "sysid/logs/finite_values.h"
#include "sysid/logs/first_command.h"
#include "sysid/logs/first_readings.h"
#include "sysid/logs/input_smoothing.h"
#include "sysid/logs/isolated_values.h"
#include "sysid/logs/log_columns.h"
#include "sysid/logs/sensor_codes.h"
#include "sysid/logs/signal_gaps.h"

namespace softgrip::sysid {
namespace {

using document::Problem;
using document::Problems;

/// Smallest number of samples of a log. A log with fewer samples does not determine a model with ten
/// parameters.
constexpr std::size_t fewest_samples = 50;
constexpr std::size_t fewest_command_samples = 2;
/// Limit above which a pressure certainly has a wrong unit. A soft finger moves by about 10 mm at 20 to 60
/// kPa.
constexpr double largest_pressure_kpa = 5000;
constexpr double largest_displacement_mm = 5000;
/// Longest accepted median sampling interval [s]. Even slow processes, such as furnaces, are sampled at
/// intervals of a few minutes.
constexpr double longest_median_interval_s = 600;
constexpr double gap_intervals = 5;

std::string percent(double share) {
  return fixed(100 * share, 1) + " %";
}

/// Checks one log and collects its problems and notes.
class Check {
 public:
  Check(Log& log, const LogSource& source, Problems& problems)
      : log_(log),
        source_(source),
        problems_(problems),
        command_(extent_of(log.pressure_command_kpa).value_or(ColumnExtent{})) {}

  void run(const LogOptions& options) {
    const std::size_t fewest = options.need_readings ? fewest_samples : fewest_command_samples;
    if (log_.size() < fewest) {
      refuse(log_.size(), 1, std::to_string(log_.size()) + " samples",
             "a log must have at least " + std::to_string(fewest));
      return;
    }
    if (!time_increases()) return;
    sampling_ = sampling_of(log_);
    time_plausible();
    magnitudes(options.command_unit);
    if (!options.need_readings) return;
    remove_empty_columns();
    first_command();
    first_readings();
    isolated_pressures();
    intervals();
    missing_readings();
    missing_pressure();
    frozen("the readings remain", log_.displacement_mm, in_unit(" mm"));
    frozen("the measured pressure remains", log_.pressure_kpa, " kPa");
    if (options.require_motion) excitation();
    clipping(options.clipped_share_refused);
  }

 private:
  /// Adds a problem at the line of `sample`, or at the last line if `sample` is after the last sample.
  void refuse(std::size_t sample, int column, std::string message, std::string hint = {}) {
    Problem problem{source_.file, {1, column}, {}, std::move(message), std::move(hint)};
    if (!source_.line.empty()) {
      const std::size_t at = std::min(sample, source_.line.size() - 1);
      problem.at.line = source_.line[at];
      problem.line_text = std::string(source_.line_text[at].substr(0, 200));
    }
    problems_.add(std::move(problem));
  }
  void note(std::size_t sample, std::string text) { add_note(sample, std::move(text), false); }
  void note_correction(std::size_t sample, std::string text) { add_note(sample, std::move(text), true); }
  void add_note(std::size_t sample, std::string text, bool corrects) {
    log_.notes.push_back(
        {sample < source_.line.size() ? source_.line[sample] : 0, std::move(text), corrects});
  }

  [[nodiscard]] std::string in_unit(std::string_view text) const {
    return model::in_unit(text, log_.output_unit);
  }

  /// Removes the optional columns with fewer than two values, because they cannot be interpolated.
  void remove_empty_columns() {
    for (const KnownColumn& known : known_columns) {
      std::vector<double>& values = log_.*known.values;
      if (known.required || values.empty() || finite_count(values) > 1) continue;
      values.clear();
      note_correction(0, "the column " + std::string(known.name) +
                             " has fewer than two values, so it is treated as missing");
    }
  }

  bool time_increases() {
    int found = 0;
    for (std::size_t i = 1; i < log_.size(); ++i) {
      const double step = log_.time_s[i] - log_.time_s[i - 1];
      if (step > 0) continue;
      if (++found <= 3) {
        const std::string hint = i > 1 && log_.time_s[i] == 0
                                     ? "if the file contains two runs, give each run as a separate log"
                                     : std::string();
        refuse(i, source_.time_column,
               step == 0 ? "the time " + shortest(log_.time_s[i]) + " s occurs twice"
                         : "the time goes back from " + shortest(log_.time_s[i - 1]) + " s to " +
                               shortest(log_.time_s[i]) + " s",
               hint);
      }
    }
    if (found > 3)
      refuse(log_.size(), source_.time_column,
             std::to_string(found - 3) + " more samples have a time that does not increase");
    return found == 0;
  }

  void time_plausible() {
    const double start = log_.time_s.front();
    if (std::abs(start) > 1.5 * sampling_.median_interval_s) {
      refuse(0, source_.time_column, "the time starts at " + significant(start, 6) + " s",
             "the times of a log must start at 0: subtract the first time");
    }
    if (sampling_.median_interval_s > longest_median_interval_s) {
      refuse(0, source_.time_column, "samples are " + significant(sampling_.median_interval_s) + " s apart",
             "if the time is in milliseconds, divide the time by 1000");
    }
  }

  void intervals() {
    std::size_t gaps = 0;
    std::size_t longest = 0;
    double longest_s = 0;
    for (std::size_t i = 1; i < log_.size(); ++i) {
      const double interval = log_.time_s[i] - log_.time_s[i - 1];
      if (interval <= gap_intervals * sampling_.median_interval_s) continue;
      ++gaps;
      if (interval > longest_s) {
        longest = i;
        longest_s = interval;
      }
      const double change = std::abs(log_.pressure_command_kpa[i] - log_.pressure_command_kpa[i - 1]);
      if (interval > shortest_gap_s && interval > shortest_gap_intervals * sampling_.median_interval_s &&
          change > least_gap_change * command_.width()) {
        refuse(i, source_.time_column,
               "a gap of " + significant(interval) + " s in which the command changed by " +
                   significant(change) + " kPa",
               "cut the log at this gap and give the two parts as two logs");
      }
    }
    if (gaps > 0) {
      note(longest, gaps == 1 ? "1 gap in the sampling lasts " + significant(longest_s) +
                                    " s; the command is assumed to be linear during this gap"
                              : std::to_string(gaps) + " gaps in the sampling; the longest gap lasts " +
                                    significant(longest_s) +
                                    " s; the command is assumed to be linear during these gaps");
    }
    if (sampling_.jitter_s > 0.01 * sampling_.median_interval_s) {
      note(log_.size(), "irregular sampling: " + significant(1e3 * sampling_.median_interval_s) + " ms ± " +
                            significant(1e3 * sampling_.jitter_s) +
                            " ms; the log is used without resampling");
    }
  }

  [[nodiscard]] bool is_code(double value) const {
    const std::vector<double> codes = sensor_codes(log_.displacement_mm);
    return std::binary_search(codes.begin(), codes.end(), value);
  }

  /// @param command_unit  LogOptions::command_unit.
  void magnitudes(const std::string& command_unit) {
    const auto largest = [](const std::vector<double>& values) {
      return static_cast<std::size_t>(std::max_element(values.begin(), values.end(),
                                                       [](double a, double b) {
                                                         return (std::isfinite(a) ? std::abs(a) : -1) <
                                                                (std::isfinite(b) ? std::abs(b) : -1);
                                                       }) -
                                      values.begin());
    };
    const std::size_t p = largest(log_.pressure_command_kpa);
    const std::size_t y = largest(log_.displacement_mm);
    if (std::abs(log_.pressure_command_kpa[p]) > largest_pressure_kpa) {
      refuse(p, source_.command_column,
             "a command of " + significant(log_.pressure_command_kpa[p]) +
                 " kPa; the permitted magnitude is at most " + significant(largest_pressure_kpa) + " kPa",
             command_unit.empty()
                 ? "if the column is in Pa, divide the values by 1000"
                 : "the command was converted from " + command_unit +
                       ". If its values have a different unit, give this unit, such as --unit command=kPa");
    }
    if (std::abs(log_.displacement_mm[y]) > largest_displacement_mm) {
      refuse(y, source_.displacement_column,
             in_unit("a displacement of ") + significant(log_.displacement_mm[y]) +
                 in_unit(" mm; the permitted magnitude is at most ") + significant(largest_displacement_mm) +
                 in_unit(" mm"),
             is_code(log_.displacement_mm[y])
                 ? "if this value is a code for a missing reading, remove it with softgrip import --missing"
             : log_.output_unit == model::OutputUnit::deg
                 ? "check if the column is in degrees"
                 : "if the column is in micrometres, divide the values by 1000");
    }
  }

  /// Replaces a wrong command at the beginning, because a fit would assume that the finger begins under it.
  void first_command() {
    const std::optional<WrongFirstCommand> wrong = wrong_first_command(log_);
    if (!wrong) return;
    std::fill_n(log_.pressure_command_kpa.begin(), wrong->samples, wrong->next_kpa);
    note_correction(0, "the log begins with a command of " + significant(wrong->command_kpa) + " kPa in " +
                           std::to_string(wrong->samples) + (wrong->samples == 1 ? " sample" : " samples") +
                           ", but the readings belong to the next command, " + significant(wrong->next_kpa) +
                           " kPa, which was used instead");
  }

  /// Removes wrong readings at the beginning, because the initial state is estimated from the first readings.
  void first_readings() {
    const std::optional<WrongFirstReadings> wrong = wrong_first_readings(log_);
    if (!wrong) return;
    note_correction(0, (wrong->count == 1 ? "the first reading was"
                                          : "the first " + std::to_string(wrong->count) + " readings were") +
                           " removed: the jump from " + significant(wrong->last_mm) + " to " +
                           significant(wrong->next_mm) + in_unit(" mm has no cause in the pressure"));
    std::fill_n(log_.displacement_mm.begin(), wrong->samples, std::numeric_limits<double>::quiet_NaN());
  }

  /// Removes isolated values of the measured pressure. A fit with the measured pressure as its input would
  /// otherwise follow them. The pressure may follow a pulse of the command, so a distance that is not larger
  /// than the change of the command is no error.
  void isolated_pressures() {
    std::vector<double>& pressure = log_.pressure_kpa;
    const double noise_kpa =
        std::max(white_noise_of(log_.time_s, pressure), least_noise_share * usual_span(pressure));
    std::vector<std::size_t> wrong;
    for (const IsolatedValue& found : isolated_values(pressure, noise_kpa)) {
      const std::size_t from = found.sample - std::min(found.sample, isolated_reach);
      const auto nearby = std::span(log_.pressure_command_kpa).subspan(from);
      const auto [low, high] =
          std::ranges::minmax(nearby.first(std::min(nearby.size(), 2 * isolated_reach + 1)));
      if (std::abs(found.distance) > high - low) wrong.push_back(found.sample);
    }
    if (wrong.empty()) return;
    note_correction(wrong.front(), std::to_string(wrong.size()) + " of " + std::to_string(pressure.size()) +
                                       (wrong.size() == 1 ? " measured pressures is isolated"
                                                          : " measured pressures are isolated") +
                                       ", removed: " + listed(pressure, log_.time_s, wrong, "kPa"));
    for (const std::size_t i : wrong) pressure[i] = std::numeric_limits<double>::quiet_NaN();
  }

  void missing_readings() {
    const auto missing = [](double value) { return !std::isfinite(value); };
    const auto& readings = log_.displacement_mm;
    const auto first = std::find_if(readings.begin(), readings.end(), missing);
    if (first == readings.end()) return;
    const std::size_t count = readings.size() - finite_count(readings);
    const double share = static_cast<double>(count) / static_cast<double>(readings.size());
    const auto at = static_cast<std::size_t>(first - readings.begin());
    const std::string message = percent(share) + " of the samples have no reading";
    if (readings.size() - count < fewest_samples) {
      refuse(at, source_.displacement_column, message,
             "a log must have at least " + std::to_string(fewest_samples) + " readings");
    } else {
      note(at, message + "; these samples are simulated, but not compared with the model");
    }
  }

  void missing_pressure() {
    if (const auto gap = pressure_gap(log_))
      note(gap->first, gap_sentence(log_, *gap) +
                           "; a model that is driven by the measured pressure needs this pressure");
  }

  /// Notes a column that keeps one value while the command changes. clipping() reports extreme values.
  /// @param remains  name of the column and the verb.
  void frozen(const std::string& remains, const std::vector<double>& values, const std::string& unit) {
    const auto range = frozen_range(log_, values);
    if (!range) return;
    note(range->first, remains + " at exactly " + significant(values[range->first], 6) + unit + " from " +
                           significant(log_.time_s[range->first], 6) + " s to " +
                           significant(log_.time_s[range->last], 6) + " s, while the command changes by " +
                           significant(range->change_kpa, 3) +
                           " kPa; check if the sensor or its connection failed in this time");
  }

  void excitation() {
    if (command_.width() <= 0) {
      refuse(0, source_.command_column,
             "the command is " + significant(command_.lowest) + " kPa from start to end",
             "a model can be identified only from a log in which the pressure changes");
      return;
    }
    if (span_mm(log_) <= 0) {
      refuse(0, source_.displacement_column,
             in_unit("the displacement never changes, although the command changes"),
             "check if the sensor is connected");
    }
  }

  /// Finds readings that stay at an extreme value while the command changes. The sensor or the board clips
  /// such readings.
  void clipping(double share_refused) {
    const ColumnExtent reading = extent_of(log_.displacement_mm).value_or(ColumnExtent{});
    if (reading.width() <= 0) return;
    std::size_t clipped = 0;
    std::size_t first = log_.size();
    double value = 0;
    for (std::size_t begin = 0; begin < log_.size();) {
      const double here = log_.displacement_mm[begin];
      std::size_t end = begin + 1;
      while (end < log_.size() && log_.displacement_mm[end] == here) ++end;
      const bool extreme = here == reading.highest || here == reading.lowest;
      constexpr std::size_t shortest_run = 5;
      if (extreme && end - begin >= shortest_run && command_moves(begin, end)) {
        clipped += end - begin;
        if (first == log_.size()) {
          first = begin;
          value = here;
        }
      }
      begin = end;
    }
    if (clipped == 0) return;
    const double share = static_cast<double>(clipped) / static_cast<double>(log_.size());
    const std::string message = percent(share) + " of the readings remain at the extreme value " +
                                significant(value, 6) + in_unit(" mm while the command changes");
    if (share > share_refused) {
      refuse(first, source_.displacement_column, message,
             "the sensor saturates: move the sensor, or remove the readings of these samples");
    } else {
      note(first, message);
    }
  }
  [[nodiscard]] bool command_moves(std::size_t begin, std::size_t end) const {
    const auto [low, high] = std::minmax_element(log_.pressure_command_kpa.begin() + static_cast<long>(begin),
                                                 log_.pressure_command_kpa.begin() + static_cast<long>(end));
    return *high - *low > 0.03 * command_.width();
  }

  Log& log_;
  const LogSource& source_;
  Problems& problems_;
  ColumnExtent command_;
  Sampling sampling_;
};

}  // namespace

void check_log(Log& log, const LogSource& source, const LogOptions& options, Problems& problems) {
  Check(log, source, problems).run(options);
}

}  // namespace softgrip::sysid
