#include "sysid/import/clock.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/numbers.h"
#include "base/statistics.h"
#include "sysid/import/fingers.h"
#include "sysid/import/missing_codes.h"
#include "sysid/import/proposal.h"
#include "sysid/import/role_fit.h"

namespace softgrip::sysid {
namespace {

/// Largest time step across an overflow, as a multiple of the usual step of the clock. If the step is larger
/// than this, rows may be missing, so the overflow is not corrected.
constexpr double longest_step = 3;
/// Two clocks with different origins count as one clock if their difference varies by at most this share of
/// the usual time step.
constexpr double variation_share = 0.5;
/// Two clocks with the same origin count as one clock if they differ by at most this share of the usual time
/// step.
constexpr double equal_share = 0.05;
/// Smallest share of rising steps among the steps of a time column that are not 0. Steps of 0 are ignored,
/// because time stamps with a low resolution repeat.
constexpr double rising_share = 0.9;
/// Smallest number of rising steps of a time column with more steps than this number.
constexpr std::size_t fewest_rises = 2;
/// Largest share of rows that have a time in only one of two time columns. If the share is larger, the two
/// columns do not count as one clock.
constexpr double apart_share = 0.01;

std::vector<double> steps_of(const std::vector<double>& clock) {
  std::vector<double> steps;
  double last = std::nan("");
  for (const double value : clock) {
    if (!std::isfinite(value)) continue;
    if (std::isfinite(last)) steps.push_back(value - last);
    last = value;
  }
  return steps;
}

double usual_step(const std::vector<double>& clock) {
  std::vector<double> steps = steps_of(clock);
  steps.erase(std::remove_if(steps.begin(), steps.end(), [](double step) { return step <= 0; }), steps.end());
  return steps.empty() ? 0 : median_of(std::span<double>(steps));
}

struct Extent {
  double lowest = 0;
  double highest = 0;
};
Extent finite_extent(const std::vector<double>& values) {
  Extent extent{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    extent.lowest = std::min(extent.lowest, value);
    extent.highest = std::max(extent.highest, value);
  }
  return extent;
}

/// Returns true if overflows with the period `period` explain all backward steps of `clock`.
/// @param step  usual time step of the clock.
bool explains(const std::vector<double>& clock, double period, double step) {
  const Extent extent = finite_extent(clock);
  const bool counts_from_0 = extent.lowest >= 0 && extent.highest <= period;
  const bool is_signed = extent.lowest >= -period / 2 && extent.highest <= period / 2;
  if (period < 20 * step || (!counts_from_0 && !is_signed)) return false;
  const std::vector<double> steps = steps_of(clock);
  return std::all_of(steps.begin(), steps.end(), [&](double change) {
    return change >= 0 || (change + period > 0 && change + period <= longest_step * step);
  });
}

bool rises(const std::vector<double>& values) {
  std::vector<double> steps = steps_of(values);
  const std::size_t fewest = std::min(steps.size(), fewest_rises);
  std::erase(steps, 0.0);
  const auto forward = std::count_if(steps.begin(), steps.end(), [](double step) { return step > 0; });
  return forward > 0 && static_cast<std::size_t>(forward) >= fewest &&
         static_cast<double>(forward) >= rising_share * static_cast<double>(steps.size());
}

/// Returns true if the mapping assigns the role of the time to the column.
bool is_mapped_time(const ForeignTable& table, const Mapping& mapping, std::size_t index) {
  return std::ranges::any_of(mapping[Role::time].columns,
                             [&](const std::string& word) { return column_index(table, word) == index; });
}

/// Returns the unit of a time column; empty if the unit is unknown.
std::string time_unit(const ForeignTable& table, const Mapping& mapping, std::size_t index) {
  const TableColumn& column = table.columns[index];
  const std::string own = stated_unit(column, Quantity::time);
  const ColumnMapping& time = mapping[Role::time];
  const bool alone = time.columns.size() < 2;
  if (is_mapped_time(table, mapping, index) && !time.unit.empty() && (alone || own.empty())) return time.unit;
  return own.empty() ? epoch_unit(column) : own;
}

/// Splits a column name into words. Returns only the words that name neither a time nor a unit of time.
std::vector<std::string> telling_tokens(const std::string& name) {
  std::vector<std::string> tokens = tokens_of(name);
  const auto silent = [](const std::string& token) {
    return names_role(token, Role::time) || unit_named(token, Quantity::time).has_value();
  };
  tokens.erase(std::remove_if(tokens.begin(), tokens.end(), silent), tokens.end());
  return tokens;
}

/// Returns true if the name of a time column contains a word that identifies the role, or a word of
/// `column_name`.
/// @param column_name  name of a value column.
bool names_its_role(const std::string& time_name, Role role, const std::string& column_name) {
  const std::vector<std::string> theirs = tokens_of(column_name);
  const std::vector<std::string> tokens = telling_tokens(time_name);
  return std::any_of(tokens.begin(), tokens.end(), [&](const std::string& token) {
    return names_role(token, role) || std::find(theirs.begin(), theirs.end(), token) != theirs.end();
  });
}

/// Returns, for each role, the index of the first column with this role. If no column has the role, the index
/// is the number of columns.
std::array<std::size_t, role_count> columns_of_roles(const ForeignTable& table, const Mapping& mapping) {
  std::array<std::size_t, role_count> columns{};
  columns.fill(table.columns.size());
  for (const RoleSpec& spec : roles) {
    const ColumnMapping& mapped = mapping[spec.role];
    if (mapped.given() && spec.role != Role::time)
      columns[static_cast<std::size_t>(spec.role)] = column_index(table, mapped.columns.front());
  }
  return columns;
}

}  // namespace

std::optional<Overflow> continue_overflows(std::vector<double>& clock, double unit_s) {
  std::vector<double> periods;
  for (const double bits : {16.0, 24.0, 32.0}) {
    for (const double part : {1.0, 1e-3, 1e-6}) periods.push_back(std::exp2(bits) * part);
  }
  if (unit_s > 0) periods.push_back(day_s / unit_s);
  return continue_overflows(clock, periods);
}

std::optional<Overflow> continue_overflows(std::vector<double>& clock, std::span<const double> periods) {
  if (!goes_back(clock)) return std::nullopt;
  const double step = usual_step(clock);
  const auto found = std::find_if(periods.begin(), periods.end(),
                                  [&](double period) { return explains(clock, period, step); });
  if (step <= 0 || found == periods.end()) return std::nullopt;
  Overflow overflow{0, 0, *found};
  double last = std::nan("");
  for (std::size_t i = 0; i < clock.size(); ++i) {
    const double value = clock[i];
    if (!std::isfinite(value)) continue;
    if (value < last && overflow.count++ == 0) overflow.first = i;
    last = value;
    clock[i] = value + static_cast<double>(overflow.count) * overflow.period;
  }
  return overflow;
}

bool goes_back(const std::vector<double>& clock) {
  const std::vector<double> steps = steps_of(clock);
  return std::any_of(steps.begin(), steps.end(), [](double step) { return step < 0; });
}

std::string about_overflow(const ForeignTable& table, std::size_t column, const Overflow& overflow,
                           std::size_t row) {
  const bool has_lines = row < table.line.size();
  const bool is_text = table.columns[column].moments > 0;
  const std::string where = !is_text                    ? written(overflow.period)
                            : overflow.period == hour_s ? "the end of an hour"
                                                        : "midnight";
  return "the clock overflows at " + where + ", " + std::to_string(overflow.count) +
         (overflow.count == 1 ? " time" : " times") + ", first in " + (has_lines ? "line " : "sample ") +
         std::to_string(has_lines ? static_cast<std::size_t>(table.line[row]) : row + 1) + " of '" +
         document::shown(word_of(table, column), 40) + "', and the times after each overflow are corrected";
}

std::vector<std::size_t> time_columns(const ForeignTable& table) {
  std::vector<std::size_t> times;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const TableColumn& column = table.columns[i];
    const bool may_be = fitness_for(column, Role::time) > 0;
    if (may_be && (column.moments > 0 || rises(column.values))) times.push_back(i);
  }
  return times;
}

std::optional<std::vector<double>> seconds_of(const ForeignTable& table, const Mapping& mapping,
                                              std::size_t column, std::optional<Overflow>* overflow) {
  std::vector<double> values = without_codes(table, mapping, column);
  const bool is_mapped = is_mapped_time(table, mapping, column);
  const auto scale = is_mapped ? mapping[Role::time].scale : std::nullopt;
  double factor = scale.value_or(1);
  if (overflow != nullptr) overflow->reset();
  if (table.columns[column].moments == 0) {
    const auto unit = unit_named(time_unit(table, mapping, column), Quantity::time);
    if (!unit && !scale) return std::nullopt;
    if (!scale) factor = unit->factor;
    const auto found = continue_overflows(values, factor);
    if (overflow != nullptr) *overflow = found;
  }
  const double begin_s = seconds(table.columns[column].first_moment);
  for (double& value : values) value = factor * (begin_s + value);
  return values;
}

bool same_clock(const ForeignTable& table, const Mapping& mapping, std::size_t a, std::size_t b) {
  const auto first = seconds_of(table, mapping, a);
  const auto second = seconds_of(table, mapping, b);
  if (!first || !second) return false;
  std::vector<double> differences;
  std::size_t apart = 0;
  for (std::size_t i = 0; i < first->size(); ++i) {
    if (std::isfinite((*first)[i]) != std::isfinite((*second)[i])) ++apart;
    if (std::isfinite((*first)[i]) && std::isfinite((*second)[i]))
      differences.push_back((*second)[i] - (*first)[i]);
  }
  const auto rows = static_cast<double>(first->size());
  if (differences.size() < 2 || static_cast<double>(apart) > apart_share * rows) return false;
  const double step = usual_step(*first);
  const Extent spread = finite_extent(differences);
  const Extent span = finite_extent(*first);
  const bool other_origin = std::abs(differences.front()) > span.highest - span.lowest;
  if (other_origin) return spread.highest - spread.lowest <= variation_share * step;
  return std::max(std::abs(spread.lowest), std::abs(spread.highest)) <= equal_share * step;
}

std::optional<std::array<std::size_t, role_count>> times_of_roles(const ForeignTable& table,
                                                                  const Mapping& mapping,
                                                                  const std::vector<std::size_t>& times) {
  const std::array<std::size_t, role_count> columns = columns_of_roles(table, mapping);
  const std::size_t none = table.columns.size();
  std::array<std::size_t, role_count> by_name{};
  std::array<std::size_t, role_count> by_order{};
  by_name.fill(none);
  by_order.fill(none);
  bool named = true;
  bool ordered = true;
  for (std::size_t i = 1; i < times.size(); ++i) ordered = ordered && times[i] > times[i - 1] + 1;
  for (const RoleSpec& spec : roles) {
    const auto role = static_cast<std::size_t>(spec.role);
    if (columns[role] == none) continue;
    for (const std::size_t time : times) {
      if (names_its_role(table.columns[time].name, spec.role, table.columns[columns[role]].name)) {
        named = named && by_name[role] == none;
        by_name[role] = time;
      }
      if (time < columns[role]) by_order[role] = time;
    }
    named = named && by_name[role] != none;
    ordered = ordered && by_order[role] != none;
  }
  if (named) return by_name;
  if (ordered) return by_order;
  return std::nullopt;
}

}  // namespace softgrip::sysid
