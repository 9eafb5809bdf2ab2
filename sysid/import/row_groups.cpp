#include "sysid/import/row_groups.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string_view>

#include "base/numbers.h"
#include "base/text.h"
#include "document/problem.h"
#include "sysid/import/fingers.h"

namespace softgrip::sysid {
namespace {

/// A group has at most this share of the steps back or of the repeated times of all rows. The share would be
/// near 1 if the column had no relation to the times. A recorder may repeat a few rows.
constexpr double largest_disorder_share = 0.05;
/// The readings of consecutive rows of a group differ by at most this share of the difference of consecutive
/// rows of the table. The share would be near 1 if the column had no relation to the readings.
constexpr double largest_step_share = 0.5;

/// Counts of steps between consecutive samples.
struct Steps {
  std::size_t repeated = 0;
  std::size_t back = 0;
  double reading = 0;  ///< sum of the magnitudes of all steps of the reading
  std::size_t readings = 0;

  [[nodiscard]] std::size_t disorder() const { return repeated + back; }
  [[nodiscard]] double mean_reading() const {
    return readings == 0 ? 0 : reading / static_cast<double>(readings);
  }
};

/// Adds the steps between consecutive samples of one group.
class StepCounter {
 public:
  void add(double time, double reading, Steps& steps) {
    if (std::isfinite(time)) {
      steps.repeated += time == time_ ? 1 : 0;
      steps.back += time < time_ ? 1 : 0;
      time_ = time;
    }
    if (!std::isfinite(reading)) return;
    if (std::isfinite(reading_)) {
      steps.reading += std::abs(reading - reading_);
      ++steps.readings;
    }
    reading_ = reading;
  }

 private:
  double time_ = missing_value;
  double reading_ = missing_value;
};

double reading_of(const ForeignSamples& samples, std::size_t i) {
  const std::vector<double>& readings = samples[Role::displacement];
  return readings.empty() ? missing_value : readings[i];
}

Steps steps_of_all(const ForeignSamples& samples) {
  Steps steps;
  StepCounter counter;
  for (std::size_t i = 0; i < samples.size(); ++i)
    counter.add(samples[Role::time][i], reading_of(samples, i), steps);
  return steps;
}

/// Returns the steps within the groups of a column. Returns nullopt if the column does not separate the rows
/// into 2 to most_fingers groups.
std::optional<Steps> steps_within(const TableColumn& column, const ForeignSamples& samples,
                                  std::vector<double>& values) {
  Steps steps;
  std::vector<StepCounter> counters;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double value = column.values[samples.row[i]];
    if (!std::isfinite(value)) return std::nullopt;
    const auto found = std::find(values.begin(), values.end(), value);
    const auto group = static_cast<std::size_t>(found - values.begin());
    if (found == values.end()) {
      if (values.size() == most_fingers) return std::nullopt;
      values.push_back(value);
      counters.emplace_back();
    }
    counters[group].add(samples[Role::time][i], reading_of(samples, i), steps);
  }
  if (values.size() < 2) return std::nullopt;
  return steps;
}

}  // namespace

std::optional<RowGroups> row_groups(const ForeignTable& table, const RoleSources& sources,
                                    const ForeignSamples& samples) {
  const Steps all = steps_of_all(samples);
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const TableColumn& column = table.columns[i];
    if (sources.uses(i) || column.is_part_of_time || column.moments > 0 || column.bad_count > 0) continue;
    RowGroups groups{word_of(table, i), {}, all.disorder() > 0};
    const auto within = steps_within(column, samples, groups.values);
    if (!within) continue;
    const bool named = names_group(column.name);
    const bool smooth =
        all.mean_reading() > 0 && within->mean_reading() <= largest_step_share * all.mean_reading();
    const bool ordered = static_cast<double>(within->disorder()) <=
                         largest_disorder_share * static_cast<double>(all.disorder());
    // A column that counts the rows of each time stamp also separates rows with equal times.
    const bool separates = all.back > 0       ? ordered
                           : all.repeated > 0 ? ordered && (named || smooth)
                                              : named && smooth;
    if (separates) return groups;
  }
  return std::nullopt;
}

bool names_group(std::string_view name) {
  constexpr std::array<std::string_view, 12> groups{"id",     "run",      "trial",      "test",
                                                    "device", "finger",   "channel",    "actuator",
                                                    "sensor", "specimen", "experiment", "module"};
  constexpr std::array<std::string_view, 5> fillers{"no", "nr", "num", "number", "name"};
  const auto is_one_of = [](const auto& words, const std::string& token) {
    return std::find(words.begin(), words.end(), token) != words.end();
  };
  const std::vector<std::string> tokens = tokens_of(name.substr(name.find_last_of("/.") + 1));
  return std::any_of(tokens.begin(), tokens.end(),
                     [&](const std::string& token) { return is_one_of(groups, token); }) &&
         std::all_of(tokens.begin(), tokens.end(), [&](const std::string& token) {
           return is_one_of(groups, token) || is_one_of(fillers, token) ||
                  std::isdigit(static_cast<unsigned char>(token.front())) != 0;
         });
}

std::string about_groups(const ForeignTable& table, const RowGroups& groups) {
  const std::string column = "'" + document::shown(groups.column, 40) + "'";
  const std::string values = with_commas(groups.values, [](double value) { return shortest(value); });
  const bool has_name_line = (table.has_separators || !table.sheet.empty()) &&
                             column_index(table, groups.column) < table.columns.size() &&
                             !table.columns[column_index(table, groups.column)].name.empty();
  return "the rows seem to belong to several runs or devices, because the column " + column + " (values " +
         values + ") separates them: in the rows of each value, the " +
         (groups.by_times ? "times increase. " : "reading changes less from row to row. ") +
         (has_name_line ? "Write the rows of each value to a separate file. Or rename the column " + column +
                              " to 'channel', and select the rows of one value with --channel " +
                              shortest(groups.values.front())
                        : "Export the rows of each value to a separate file");
}

}  // namespace softgrip::sysid
