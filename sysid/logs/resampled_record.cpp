#include "sysid/logs/resampled_record.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "sysid/logs/finite_values.h"
#include "sysid/logs/log_columns.h"

namespace softgrip::sysid {
namespace {

/// Limit of a jump of the command, as a share of the largest command. The command jumps between two kept
/// samples if a removed sample between them deviates by more than this limit from the straight line through
/// the two kept samples.
constexpr double least_jump = 0.01;

/// Returns the weighted mean of the command around sample `at`. The weights are triangular over the removed
/// samples on either side.
double hat_mean_kpa(const std::vector<double>& drive_kpa, std::size_t at, std::size_t stride) {
  const double width = static_cast<double>(stride);
  double sum_kpa = drive_kpa[at];
  for (std::size_t j = 1; j < stride; ++j)
    sum_kpa += (1 - static_cast<double>(j) / width) * (drive_kpa[at - j] + drive_kpa[at + j]);
  return sum_kpa / width;
}

/// Returns true if the command jumps between sample `at` and the next sample that is kept.
bool jumps_after(const Record& record, std::size_t at, std::size_t stride) {
  const double from_kpa = record.drive_kpa[at], to_kpa = record.drive_kpa[at + stride];
  for (std::size_t j = 1; j < stride; ++j) {
    const double share = static_cast<double>(j) / static_cast<double>(stride);
    const double straight_kpa = from_kpa + share * (to_kpa - from_kpa);
    if (std::abs(record.drive_kpa[at + j] - straight_kpa) > least_jump * record.largest_kpa) return true;
  }
  return false;
}

/// Replaces a command that is held, or that jumps, by its local mean. Without this replacement, a jump
/// between two kept samples would be early or late by up to one interval of the kept samples. A command whose
/// slope changes without a jump is not replaced.
void keep_mean_of_jumps(const Record& record, std::size_t stride, Record& thin) {
  if (record.held) {
    for (std::size_t to = 0; to + 1 < thin.size(); ++to) {
      const auto first = record.drive_kpa.begin() + static_cast<long>(to * stride);
      thin.drive_kpa[to] =
          std::accumulate(first, first + static_cast<long>(stride), 0.0) / static_cast<double>(stride);
    }
    return;
  }
  bool jumped = false;
  for (std::size_t to = 1; (to + 1) * stride < record.size(); ++to) {
    const bool jumps = jumps_after(record, to * stride, stride);
    if (jumps || jumped) thin.drive_kpa[to] = hat_mean_kpa(record.drive_kpa, to * stride, stride);
    jumped = jumps;
  }
}

std::size_t stride_for(const Record& record, double interval_s) {
  return static_cast<std::size_t>(std::max(1.0, std::floor(interval_s / record.mean_interval_s())));
}

/// Returns the mean of a reading and its neighbours, up to `reach` readings on either side. Returns NaN if at
/// most half of these readings are finite.
double mean_around(const std::vector<double>& readings, std::size_t at, std::size_t reach) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = at - reach; i <= at + reach; ++i) {
    if (!std::isfinite(readings[i])) continue;
    sum += readings[i];
    ++count;
  }
  return 2 * count > 2 * reach ? sum / static_cast<double>(count) : std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::size_t> nearest_to_centres(const Record& record, double interval_s) {
  const auto intervals = [&](std::size_t i) {
    return (record.time_s[i] - record.time_s.front()) / interval_s + 1e-9;
  };
  const auto off_centre = [&](std::size_t i) {
    return std::abs(intervals(i) - std::floor(intervals(i)) - 0.5);
  };
  std::vector<std::size_t> kept{0};
  for (std::size_t i = 1; i < record.size(); ++i) {
    const bool another = kept.size() == 1 || std::floor(intervals(i)) > std::floor(intervals(kept.back()));
    if (another)
      kept.push_back(i);
    else if (off_centre(i) < off_centre(kept.back()))
      kept.back() = i;
  }
  return kept;
}

/// Divides each step of a series into `parts` steps.
/// @param between  function that interpolates the additional values.
template <class Between>
std::vector<double> finer(const std::vector<double>& series, std::size_t parts, Between&& between) {
  std::vector<double> out;
  if (series.empty()) return out;
  out.reserve((series.size() - 1) * parts + 1);
  out.push_back(series.front());
  for (std::size_t i = 1; i < series.size(); ++i) {
    for (std::size_t k = 1; k < parts; ++k)
      out.push_back(between(series[i - 1], series[i], static_cast<double>(k) / static_cast<double>(parts)));
    out.push_back(series[i]);
  }
  return out;
}

}  // namespace

Record thinned_record(const Record& record, std::span<const std::size_t> kept) {
  Record thin = record;
  // Each column keeps the first value of each group of samples. The duration of a kept step is the sum of the
  // durations of the original steps. A held command has the value of its first original step.
  for (auto* column :
       {&thin.time_s, &thin.drive_kpa, &thin.reading_mm, &thin.temperature_c, &thin.supply_kpa}) {
    if (column->empty()) continue;
    for (std::size_t to = 0; to < kept.size(); ++to) (*column)[to] = (*column)[kept[to]];
    column->resize(kept.size());
  }
  thin.duration_s.assign(kept.size(), 0);
  thin.sample_time_s = 0;
  thin.readings = finite_count(thin.reading_mm);
  for (std::size_t i = 1; i < thin.size(); ++i)
    thin.duration_s[i] = step_duration_s(thin.time_s[i] - thin.time_s[i - 1]);
  return thin;
}

Record thinned_record(const Record& record, std::size_t stride) {
  std::vector<std::size_t> kept;
  kept.reserve(record.size() / stride + 1);
  for (std::size_t i = 0; i < record.size(); i += stride) kept.push_back(i);
  Record thin = thinned_record(record, kept);
  thin.sample_time_s = record.sample_time_s * static_cast<double>(stride);
  if (stride > 1) keep_mean_of_jumps(record, stride, thin);
  return thin;
}

Record thinned_to(const Record& record, double interval_s) {
  const std::size_t stride = stride_for(record, interval_s);
  return stride > 1 ? thinned_record(record, stride) : record;
}

Record averaged_to(const Record& record, double interval_s) {
  const std::size_t stride = stride_for(record, interval_s);
  if (stride <= 1) return record;
  Record thin = thinned_record(record, stride);
  thin.finest_interval_s = thin.mean_interval_s();
  for (std::size_t to = 0; to < thin.size(); ++to) {
    const std::size_t at = to * stride;
    const std::size_t reach = std::min({(stride - 1) / 2, at, record.size() - 1 - at});
    thin.reading_mm[to] = mean_around(record.reading_mm, at, reach);
  }
  thin.readings = finite_count(thin.reading_mm);
  return thin;
}

std::vector<Record> averaged_to_count(std::vector<Record> records, std::size_t most, double longest_s) {
  const std::size_t readings = reading_count(records);
  if (readings <= most) return records;
  const double samples = std::ceil(static_cast<double>(readings) / static_cast<double>(most));
  for (Record& record : records)
    record = averaged_to(record, std::min((samples + 0.5) * record.mean_interval_s(), longest_s));
  return records;
}

Record thinned_to_centres(const Record& record, double interval_s) {
  if (interval_s <= record.mean_interval_s()) return record;
  Record thin = thinned_record(record, nearest_to_centres(record, interval_s));
  thin.finest_interval_s = thin.mean_interval_s();
  return thin;
}

Record finer_record(const Record& record, std::size_t parts) {
  const auto straight = [](double from, double to, double share) { return from + share * (to - from); };
  const auto held = [](double from, double, double) { return from; };
  const auto unknown = [](double, double, double) { return std::numeric_limits<double>::quiet_NaN(); };
  Record fine = record;
  fine.time_s = finer(record.time_s, parts, straight);
  fine.drive_kpa =
      record.held ? finer(record.drive_kpa, parts, held) : finer(record.drive_kpa, parts, straight);
  fine.reading_mm = finer(record.reading_mm, parts, unknown);
  fine.temperature_c = finer(record.temperature_c, parts, straight);
  fine.supply_kpa = finer(record.supply_kpa, parts, straight);
  fine.duration_s.assign(fine.time_s.size(), record.duration_s.front());
  for (std::size_t i = 1; i < fine.time_s.size(); ++i)
    fine.duration_s[i] = record.duration_s[(i - 1) / parts + 1] / static_cast<double>(parts);
  fine.sample_time_s = record.sample_time_s / static_cast<double>(parts);
  return fine;
}

std::vector<Record> with_fewer_readings(std::vector<Record> records, std::size_t most) {
  const std::size_t readings = reading_count(records);
  const std::size_t stride = (readings + most - 1) / std::max<std::size_t>(most, 1);
  if (stride <= 1) return records;
  for (Record& record : records) {
    std::size_t seen = 0;
    for (double& y : record.reading_mm) {
      if (!std::isfinite(y)) continue;
      if (seen++ % stride != 0) y = std::numeric_limits<double>::quiet_NaN();
    }
    record.readings = (seen + stride - 1) / stride;
  }
  return records;
}

std::vector<Record> first_samples(std::vector<Record> records, std::size_t most) {
  std::size_t all = 0;
  for (const Record& record : records) all += record.size();
  if (all <= most) return records;
  for (Record& record : records) {
    const std::size_t kept = std::min(std::max<std::size_t>(record.size() * most / all, 2), record.size());
    for (auto* column : {&record.time_s, &record.duration_s, &record.drive_kpa, &record.reading_mm,
                         &record.temperature_c, &record.supply_kpa}) {
      if (!column->empty()) column->resize(kept);
    }
    record.readings = finite_count(record.reading_mm);
  }
  return records;
}

Log thinned_log(const Log& log, std::size_t stride) {
  Log kept = log;
  const auto thin = [stride](auto& values) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < values.size(); i += stride) std::swap(values[count++], values[i]);
    values.resize(count);
  };
  for (const KnownColumn& known : known_columns) thin(kept.*known.values);
  for (OtherColumn& other : kept.others) thin(other.cells);
  return kept;
}

}  // namespace softgrip::sysid
