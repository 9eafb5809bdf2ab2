#include "sysid/logs/signal_gaps.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/numbers.h"
#include "base/statistics.h"
#include "sysid/logs/finite_values.h"

namespace softgrip::sysid {
namespace {

/// Returns the smallest change of the command that counts as a change [kPa].
double least_change_kpa(const Log& log) {
  return least_gap_change * width_of(log.pressure_command_kpa);
}

SignalGap gap_between(const Log& log, std::size_t first, std::size_t last) {
  const auto [low, high] =
      std::minmax_element(log.pressure_command_kpa.begin() + static_cast<std::ptrdiff_t>(first),
                          log.pressure_command_kpa.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  return {first, last, log.time_s[last] - log.time_s[first], *high - *low};
}

/// Successive equal values: elements [begin, end) of a list of samples.
struct Run {
  std::size_t begin = 0;
  std::size_t end = 0;
};

std::vector<Run> runs_of(const std::vector<double>& values, const std::vector<std::size_t>& samples) {
  std::vector<Run> runs;
  for (std::size_t begin = 0; begin < samples.size();) {
    std::size_t end = begin + 1;
    while (end < samples.size() && values[samples[end]] == values[samples[begin]]) ++end;
    runs.push_back({begin, end});
    begin = end;
  }
  return runs;
}

}  // namespace

std::optional<SignalGap> pressure_gap(const Log& log) {
  std::vector<std::size_t> ends = finite_values(log.pressure_kpa).samples;
  if (ends.size() < 2) return {};
  std::vector<double> intervals_s;
  for (std::size_t k = 1; k < ends.size(); ++k)
    intervals_s.push_back(log.time_s[ends[k]] - log.time_s[ends[k - 1]]);
  const double shortest_s =
      std::max(shortest_gap_s, shortest_gap_intervals * median_of(std::span(intervals_s)));
  if (ends.front() > 0) ends.insert(ends.begin(), 0);
  if (ends.back() + 1 < log.size()) ends.push_back(log.size() - 1);
  std::optional<SignalGap> longest;
  for (std::size_t k = 1; k < ends.size(); ++k) {
    // Between two neighbouring samples, no measured pressure is missing.
    if (ends[k] == ends[k - 1] + 1 || log.time_s[ends[k]] - log.time_s[ends[k - 1]] <= shortest_s) continue;
    const SignalGap gap = gap_between(log, ends[k - 1], ends[k]);
    if (gap.change_kpa > least_change_kpa(log) && (!longest || gap.length_s > longest->length_s))
      longest = gap;
  }
  return longest;
}

std::string gap_sentence(const Log& log, const SignalGap& gap) {
  return "a gap of " + significant(gap.length_s, 3) + " s in the measured pressure, from " +
         significant(log.time_s[gap.first], 6) + " s to " + significant(log.time_s[gap.last], 6) +
         " s, in which the command changed by " + significant(gap.change_kpa, 3) + " kPa";
}

std::optional<SignalGap> frozen_range(const Log& log, const std::vector<double>& values) {
  const std::vector<std::size_t> samples = finite_values(values).samples;
  const std::vector<Run> runs = runs_of(values, samples);
  const ColumnExtent extent = extent_of(values).value_or(ColumnExtent{});
  if (runs.empty()) return {};
  std::vector<double> lengths;
  for (const Run& run : runs) lengths.push_back(static_cast<double>(run.end - run.begin));
  const double shortest = shortest_gap_intervals * median_of(std::span(lengths));
  const double change_kpa = least_change_kpa(log);
  std::optional<SignalGap> longest;
  for (const Run& run : runs) {
    const std::size_t first = samples[run.begin], last = samples[run.end - 1];
    if (values[first] == extent.lowest || values[first] == extent.highest) continue;
    std::size_t changed = run.begin;
    while (changed < run.end && std::abs(log.pressure_command_kpa[samples[changed]] -
                                         log.pressure_command_kpa[first]) <= change_kpa)
      ++changed;
    if (static_cast<double>(run.end - changed) <= shortest) continue;
    if (log.time_s[last] - log.time_s[samples[changed]] <= shortest_gap_s) continue;
    const SignalGap range = gap_between(log, first, last);
    if (!longest || range.length_s > longest->length_s) longest = range;
  }
  return longest;
}

}  // namespace softgrip::sysid
