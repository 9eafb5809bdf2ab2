#include "sysid/diagnosis/residual/sampling.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/statistics.h"
#include "sysid/diagnosis/residual/noise.h"
#include "sysid/diagnosis/residual/resolution.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// Largest ratio of the smallest changes of the reading to the typical change for which the resolution of a
/// sensor counts as fine.
constexpr double fine_share = 0.25;
/// Limits of the conditions for a frozen reading (see hide_repeated()): the length of an interval of equal
/// readings, as a multiple of the 95 % quantile of such intervals, and the change of the drive in the
/// interval, as a share of its range.
constexpr double frozen_ratio = 5, moved_share = 0.1;

/// An interval of equal consecutive readings. `first` is an index of the vector `samples`.
struct Stretch {
  std::size_t first = 0, length = 0;
};

struct Stretches {
  std::vector<std::size_t> samples;
  std::vector<Stretch> stretches;
  /// 95 % quantile of the lengths of the complete intervals. Infinity: there are too few intervals.
  double usual_length = std::numeric_limits<double>::infinity();
};

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// Returns the lengths of all intervals of equal readings [samples]. The first and the last interval may be
/// incomplete, so they are left out.
std::vector<double> whole_lengths(const Stretches& readings) {
  std::vector<double> lengths;
  for (std::size_t k = 1; k + 1 < readings.stretches.size(); ++k)
    lengths.push_back(static_cast<double>(readings.stretches[k].length));
  return lengths;
}

Stretches stretches_of(const Record& record) {
  Stretches all;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (!std::isfinite(record.reading_mm[i])) continue;
    const bool is_new = all.samples.empty() || record.reading_mm[i] != record.reading_mm[all.samples.back()];
    if (is_new) all.stretches.push_back({all.samples.size(), 0});
    all.samples.push_back(i);
    ++all.stretches.back().length;
  }
  if (all.stretches.size() >= limits::fewest_events) all.usual_length = quantile(whole_lengths(all), 0.95);
  return all;
}

bool is_fine(const Record& record, const Stretches& readings) {
  std::vector<double> changes;
  for (std::size_t k = 1; k < readings.stretches.size(); ++k) {
    const std::size_t first = readings.stretches[k].first;
    changes.push_back(std::abs(record.reading_mm[readings.samples[first]] -
                               record.reading_mm[readings.samples[first - 1]]));
  }
  return quantile(changes, 0.05) < fine_share * quantile(changes, 0.5);
}

/// Returns the median number of samples from one new reading to the next. Returns 1 if the sensor does not
/// count as slower than its log (see hide_repeated()).
std::size_t samples_per_reading(const Record& record, const Stretches& readings) {
  const std::vector<double> lengths = whole_lengths(readings);
  if (lengths.size() < limits::fewest_events || quantile(lengths, 0.1) < 2 || !is_fine(record, readings))
    return 1;
  return static_cast<std::size_t>(quantile(lengths, 0.5));
}

/// Returns true if the interval is long, and its reading is neither the lowest nor the highest one.
bool may_be_frozen(const Record& record, const Stretches& readings, const Stretch& stretch) {
  if (static_cast<double>(stretch.length) < frozen_ratio * readings.usual_length) return false;
  const double value = record.reading_mm[readings.samples[stretch.first]];
  const auto [low, high] = std::minmax_element(
      readings.samples.begin(), readings.samples.end(),
      [&](std::size_t a, std::size_t b) { return record.reading_mm[a] < record.reading_mm[b]; });
  return value != record.reading_mm[*low] && value != record.reading_mm[*high];
}

bool drive_moves_in(const Record& record, const Stretches& readings, const Stretch& stretch) {
  const auto begin = record.drive_kpa.begin();
  const auto [least, most] = std::minmax_element(
      begin + static_cast<std::ptrdiff_t>(readings.samples[stretch.first]),
      begin + static_cast<std::ptrdiff_t>(readings.samples[stretch.first + stretch.length - 1]) + 1);
  const auto [lowest, highest] = std::minmax_element(begin, record.drive_kpa.end());
  return *most - *least > moved_share * (*highest - *lowest);
}

/// Returns true if the reading of a record is frozen while the drive moves.
bool freezes_in_motion(const Record& record, const Stretches& readings) {
  return std::ranges::any_of(readings.stretches, [&](const Stretch& stretch) {
    return may_be_frozen(record, readings, stretch) && drive_moves_in(record, readings, stretch);
  });
}

/// Returns the sum of the squared distances between the hidden readings and straight lines. Each line
/// connects the last kept reading before the hidden reading with the first kept reading after it.
double squares_beside_lines(const Record& before, const Record& after) {
  double squares = 0;
  std::size_t last = after.size();
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (!std::isfinite(after.reading_mm[i])) continue;
    for (std::size_t j = last + 1; last < after.size() && j < i; ++j) {
      const double part = (after.time_s[j] - after.time_s[last]) / (after.time_s[i] - after.time_s[last]);
      const double line = std::lerp(after.reading_mm[last], after.reading_mm[i], part);
      if (std::isfinite(before.reading_mm[j])) squares += square(before.reading_mm[j] - line);
    }
    last = i;
  }
  return squares;
}

}  // namespace

SamplingEvidence hide_repeated(std::vector<Record>& records) {
  SamplingEvidence evidence;
  evidence.step_mm = coarse_step_mm(records);
  for (Record& record : records) record.step_mm = evidence.step_mm;
  std::vector<Record> fresh = records;
  std::vector<double> intervals_s;
  double squares = 0;
  std::vector<Stretches> all;
  all.reserve(records.size());
  bool freezes = false;
  for (const Record& record : records) {
    all.push_back(stretches_of(record));
    freezes = freezes || freezes_in_motion(record, all.back());
  }
  for (std::size_t r = 0; r < records.size(); ++r) {
    Record& record = fresh[r];
    const Stretches& readings = all[r];
    evidence.readings += readings.samples.size();
    if (readings.stretches.size() < limits::fewest_events) continue;
    const std::size_t period = samples_per_reading(record, readings);
    if (period > 1) intervals_s.push_back(static_cast<double>(period) * record.mean_interval_s());
    for (const Stretch& stretch : readings.stretches) {
      const bool frozen =
          may_be_frozen(records[r], readings, stretch) &&
          (drive_moves_in(records[r], readings, stretch) || (freezes && readings.usual_length < 2));
      const std::size_t kept_each = frozen ? stretch.length : period;
      const std::size_t last = readings.samples[stretch.first + stretch.length - 1];
      if (frozen) evidence.frozen_s += record.time_s[last] - record.time_s[readings.samples[stretch.first]];
      for (std::size_t k = 0; k < stretch.length; ++k) {
        if (k % kept_each == 0) continue;
        hide_reading(record, readings.samples[stretch.first + k]);
        ++evidence.hidden;
      }
    }
    squares += squares_beside_lines(records[r], record);
  }
  if (evidence.hidden == 0) return evidence;
  if (!intervals_s.empty()) evidence.interval_s = quantile(intervals_s, 0.5);
  evidence.excess_mm = std::sqrt(squares / static_cast<double>(evidence.readings));
  evidence.present = evidence.excess_mm > limits::hidden_by_noise * measured_noise_mm(fresh);
  if (evidence.present) records = std::move(fresh);
  return evidence;
}

void add_rounding(SamplingEvidence& evidence) {
  if (evidence.step_mm == 0) return;
  const double repeated_mm = evidence.present ? evidence.excess_mm : 0;
  evidence.excess_mm = std::hypot(repeated_mm, std::sqrt(rounding_variance_mm2(evidence.step_mm)));
  evidence.present = true;
}

}  // namespace softgrip::sysid
