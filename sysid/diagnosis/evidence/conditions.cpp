#include "sysid/diagnosis/evidence/conditions.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/statistics.h"
#include "sysid/fitting/score.h"
#include "sysid/logs/finite_values.h"

namespace softgrip::sysid {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
/// Half of the time window over which the slope of the pressure is computed [s]. Intended pressure changes
/// last longer than this window.
constexpr double half_window_s = 0.05;
constexpr std::size_t most_cycles = 8;

void add_rates(const Record& record, DriveHistory& h) {
  const std::vector<double>& p = record.drive_kpa;
  const double standing_kpa = 5e-4 * record.largest_kpa + 4 * std::sqrt(2.0) * third_difference_noise(p);
  const double zero_kpa = 0.02 * record.largest_kpa;
  std::size_t before = 0, after = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    while (record.time_s[i] - record.time_s[before] > half_window_s) ++before;
    while (after + 1 < p.size() && record.time_s[after] - record.time_s[i] < half_window_s) ++after;
    after = std::max(after, i);
    // If there is no earlier sample within the window, the slope starts at the previous sample.
    const std::size_t a = before == i && i > 0 ? i - 1 : before;
    const double change = p[after] - p[a];
    const double time = record.time_s[after] - record.time_s[a];
    const bool moves = std::abs(change) > standing_kpa && time > 0;
    h.rate_kpa_per_s.push_back(moves ? change / time : 0);
    h.branch.push_back(moves ? (change > 0 ? Branch::loading : Branch::unloading)
                             : (std::abs(p[i]) < zero_kpa ? Branch::rest : Branch::hold));
  }
}

void add_turns(const Record& record, DriveHistory& h) {
  double turned_s = record.time_s.front();
  double largest = record.largest_before_kpa;
  bool falling = false;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (i > 0 && h.branch[i] != h.branch[i - 1]) turned_s = record.time_s[i];
    const bool stands = h.branch[i] == Branch::rest || h.branch[i] == Branch::hold;
    largest = std::max(largest, record.drive_kpa[i]);
    if (!stands) falling = h.branch[i] == Branch::unloading;
    h.falling.push_back(falling);
    h.dwell_s.push_back(stands ? record.time_s[i] - turned_s : none);
    h.largest_kpa.push_back(largest);
  }
}

void add_amplitudes(const Record& record, DriveHistory& h) {
  const std::vector<double>& p = record.drive_kpa;
  const auto [low, high] = std::minmax_element(p.begin(), p.end());
  const double threshold = *low + 0.03 * (*high - *low);
  h.amplitude_kpa.assign(p.size(), none);
  double last = none;
  for (std::size_t i = 0; i < p.size();) {
    std::size_t end = i;
    double peak = p[i];
    const bool out = p[i] > threshold;
    for (; end < p.size() && (p[end] > threshold) == out; ++end) peak = std::max(peak, p[end]);
    if (out) last = peak;
    std::fill(h.amplitude_kpa.begin() + static_cast<long>(i),
              h.amplitude_kpa.begin() + static_cast<long>(end), last);
    i = end;
  }
}

/// Returns a condition and its value at each sample.
/// @param value  function that computes the value from the index of a record and the index of a sample.
template <class Value>
Condition condition(std::string id, std::string axis, std::string phrase, const Samples& samples,
                    Value&& value) {
  Condition c;
  c.id = std::move(id);
  c.axis = std::move(axis);
  c.phrase = std::move(phrase);
  c.value.reserve(samples.size());
  for (std::size_t s = 0; s < samples.size(); ++s)
    c.value.push_back(value(samples.record[s], samples.index[s]));
  return c;
}

template <class Group>
void group_by(Condition& c, const Samples& samples, std::vector<std::string> names, Group&& group) {
  c.groups = std::move(names);
  for (std::size_t s = 0; s < samples.size(); ++s)
    c.group.push_back(static_cast<std::uint8_t>(group(samples.record[s], samples.index[s])));
}

Condition column(std::string id, std::string axis, std::string phrase, const Samples& samples,
                 const std::vector<Record>& records, std::vector<double> Record::*values,
                 const std::string& name) {
  Condition c = condition(std::move(id), std::move(axis), std::move(phrase), samples,
                          [&](std::size_t k, std::size_t i) {
                            return (records[k].*values).empty() ? none : (records[k].*values)[i];
                          });
  if (!varies(c.value)) c.why_not = "the logs contain no column " + name + " that varies";
  return c;
}

}  // namespace

DriveHistory history_of(const Record& record) {
  DriveHistory h;
  add_rates(record, h);
  add_turns(record, h);
  add_amplitudes(record, h);
  const std::vector<std::size_t> starts = cycle_starts(record);
  std::size_t cycle = 0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    while (cycle + 1 < starts.size() && i >= starts[cycle + 1]) ++cycle;
    h.cycle.push_back(cycle);
  }
  return h;
}

Samples pooled_samples(const std::vector<Record>& records,
                       const std::vector<std::vector<double>>& residual_mm, std::size_t most) {
  std::size_t all = 0;
  for (const Record& record : records) all += record.size();
  const std::size_t stride = std::max<std::size_t>(1, (all + most - 1) / most);
  Samples samples;
  for (std::size_t k = 0; k < records.size(); ++k) {
    for (std::size_t i = 0; i < records[k].size(); i += stride) {
      if (!std::isfinite(residual_mm[k][i])) continue;
      samples.record.push_back(k);
      samples.index.push_back(i);
      samples.campaign_s.push_back(records[k].campaign_time_s + records[k].time_s[i]);
    }
  }
  return samples;
}

std::vector<double> pooled(const Samples& samples, const std::vector<std::vector<double>>& by_record) {
  std::vector<double> values;
  values.reserve(samples.size());
  for (std::size_t s = 0; s < samples.size(); ++s)
    values.push_back(by_record[samples.record[s]][samples.index[s]]);
  return values;
}

std::vector<Condition> conditions_of(const std::vector<Record>& records,
                                     const std::vector<std::vector<double>>& prediction_mm,
                                     const Samples& samples) {
  std::vector<DriveHistory> h;
  h.reserve(records.size());
  for (const Record& record : records) h.push_back(history_of(record));
  std::vector<Condition> list;
  list.push_back(condition(
      "branch", "direction of the pressure", "the direction of the pressure (rising, falling or constant)",
      samples, [&](std::size_t k, std::size_t i) { return static_cast<double>(h[k].branch[i]); }));
  list.back().categories = {"rest", "loading", "hold", "unloading"};
  list.push_back(condition("cycle", "cycle of the log", "the cycle of the log", samples,
                           [&](std::size_t k, std::size_t i) {
                             return static_cast<double>(std::min(h[k].cycle[i], most_cycles - 1));
                           }));
  for (std::size_t c = 1; c <= most_cycles; ++c)
    list.back().categories.push_back(std::to_string(c) + (c == most_cycles ? "+" : ""));
  list.push_back(condition("amplitude", "peak pressure of the stroke [kPa]",
                           "the peak pressure of the stroke", samples,
                           [&](std::size_t k, std::size_t i) { return h[k].amplitude_kpa[i]; }));
  list.push_back(condition("rate", "rate of the pressure [kPa/s]", "the rate of the pressure", samples,
                           [&](std::size_t k, std::size_t i) {
                             return h[k].rate_kpa_per_s[i] == 0 ? none : h[k].rate_kpa_per_s[i];
                           }));
  list.push_back(condition(
      "dwell", "time since the last pressure change [s]", "the time since the last pressure change", samples,
      [&](std::size_t k, std::size_t i) { return h[k].dwell_s[i] > 0 ? h[k].dwell_s[i] : none; }));
  list.back().logarithmic = true;
  group_by(list.back(), samples, {"at rest", "under load"},
           [&](std::size_t k, std::size_t i) { return h[k].branch[i] == Branch::hold; });
  list.push_back(condition("history", "largest pressure up to this time [kPa]",
                           "the largest pressure up to this time", samples,
                           [&](std::size_t k, std::size_t i) { return h[k].largest_kpa[i]; }));
  const auto position = [&](std::size_t k, std::size_t i) { return prediction_mm[k][i]; };
  const std::string over_position = model::in_unit(
      "predicted displacement [mm]", records.empty() ? model::OutputUnit::mm : records.front().output_unit);
  list.push_back(condition("position", over_position, "the position", samples, position));
  list.push_back(condition("loop", over_position, "the position within the loop", samples, position));
  group_by(list.back(), samples, {"loading", "unloading"},
           [&](std::size_t k, std::size_t i) { return h[k].falling[i]; });
  list.push_back(condition(
      "campaign_time", "time since the start of the logs [s]", "the time since the start of the logs",
      samples,
      [&](std::size_t k, std::size_t i) { return records[k].campaign_time_s + records[k].time_s[i]; }));
  list.push_back(column("temperature",
                        "temperature [\xc2\xb0"
                        "C]",
                        "the temperature", samples, records, &Record::temperature_c, "temperature_c"));
  list.push_back(column("supply", "supply pressure [kPa]", "the supply pressure", samples, records,
                        &Record::supply_kpa, "supply_kpa"));
  return list;
}

}  // namespace softgrip::sysid
