#include "sysid/logs/record.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "model/blocks/chamber_lag.h"
#include "model/blocks/quantisation.h"
#include "model/blocks/sensor_noise.h"
#include "model/catalogue.h"
#include "model/named.h"
#include "sysid/logs/input_smoothing.h"

namespace softgrip::sysid {
namespace {

/// Durations on a grid of a picosecond: what differs by less is rounding of the written times, and equal
/// durations share their coefficients.
double on_grid(double duration_s) {
  return std::round(duration_s * 1e12) * 1e-12;
}

void fill_missing(std::vector<double>& values) {
  std::size_t last = values.size();  // the last one that is there
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    const std::size_t from = last == values.size() ? 0 : last + 1;
    for (std::size_t j = from; j < i; ++j) {
      const double share =
          last == values.size() ? 1 : static_cast<double>(j - last) / static_cast<double>(i - last);
      values[j] = last == values.size() ? values[i] : values[last] + share * (values[i] - values[last]);
    }
    last = i;
  }
  for (std::size_t j = last + 1; j < values.size() && last < values.size(); ++j) values[j] = values[last];
}

Record make_record(const Log& log, const RecordOptions& options, double campaign_time_s) {
  Record record;
  record.name = log.name;
  record.time_s = log.time_s;
  record.drive_kpa = options.drive == Drive::measured ? log.pressure_kpa : log.pressure_command_kpa;
  record.reading_mm = log.displacement_mm;
  record.temperature_c = log.temperature_c;
  record.supply_kpa = log.supply_kpa;
  record.campaign_time_s = campaign_time_s;
  record.held = options.held;
  record.span_mm = span_mm(log);
  if (options.drive == Drive::measured)
    record.drive_noise_kpa = smooth_input(record.time_s, record.drive_kpa);
  for (auto* column : {&record.temperature_c, &record.supply_kpa})
    static_cast<void>(smooth_input(record.time_s, *column));
  for (auto* column : {&record.drive_kpa, &record.temperature_c, &record.supply_kpa}) fill_missing(*column);
  record.duration_s.resize(record.size());
  for (std::size_t i = 1; i < record.size(); ++i)
    record.duration_s[i] = on_grid(log.time_s[i] - log.time_s[i - 1]);
  const Sampling sampling = sampling_of(log);
  const double nominal = on_grid(sampling.median_interval_s);
  const double worst =
      std::max(sampling.longest_interval_s - nominal, nominal - sampling.shortest_interval_s);
  if (worst < 1e-9 * nominal + 2e-12) record.sample_time_s = nominal;
  for (const double p : record.drive_kpa) record.largest_kpa = std::max(record.largest_kpa, std::abs(p));
  for (const double y : record.reading_mm) {
    if (std::isfinite(y)) ++record.readings;
  }

  constexpr double next_to_nothing = 0.01;
  const bool pressurised = std::abs(record.drive_kpa.front()) > next_to_nothing * record.largest_kpa;
  record.start_unknown =
      options.start == Start::unknown || (options.start == Start::automatic && pressurised);
  const auto first = std::find_if(record.reading_mm.begin(), record.reading_mm.end(),
                                  [](double y) { return std::isfinite(y); });
  const bool at_zero = first != record.reading_mm.end() &&
                       std::abs(*first) < std::max(4 * fast_noise_mm(record), 1e-3 * record.span_mm);
  record.offset_free = record.start_unknown || pressurised || !at_zero;
  return record;
}

}  // namespace

std::vector<Record> make_records(const std::vector<Log>& logs, const RecordOptions& options) {
  std::vector<Record> records;
  double campaign_time_s = 0;
  double largest_kpa = 0;
  for (const Log& log : logs) {
    records.push_back(make_record(log, options, campaign_time_s));
    records.back().largest_before_kpa = largest_kpa;
    largest_kpa = std::max(largest_kpa, records.back().largest_kpa);
    campaign_time_s += log.time_s.back();
  }
  return records;
}

namespace {

std::size_t stride_for(const Record& record, double interval_s) {
  return static_cast<std::size_t>(std::max(1.0, std::floor(interval_s / record.mean_interval_s())));
}

/// Mean of `reach` readings on either side of one and itself; none where fewer than half are there.
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

}  // namespace

Record thinned_to(const Record& record, double interval_s) {
  const std::size_t stride = stride_for(record, interval_s);
  return stride > 1 ? thinned_record(record, stride) : record;
}

Record averaged_to(const Record& record, double interval_s) {
  const std::size_t stride = stride_for(record, interval_s);
  if (stride <= 1) return record;
  Record thin = thinned_record(record, stride);
  thin.readings = 0;
  for (std::size_t to = 0; to < thin.size(); ++to) {
    const std::size_t at = to * stride;
    const std::size_t reach = std::min({(stride - 1) / 2, at, record.size() - 1 - at});
    thin.reading_mm[to] = mean_around(record.reading_mm, at, reach);
    if (std::isfinite(thin.reading_mm[to])) ++thin.readings;
  }
  return thin;
}

Record thinned_record(const Record& record, std::span<const std::size_t> kept) {
  Record thin = record;
  // A held command is that of the step's begin: the thinned step takes the first of its steps for all.
  for (auto* column :
       {&thin.time_s, &thin.drive_kpa, &thin.reading_mm, &thin.temperature_c, &thin.supply_kpa}) {
    if (column->empty()) continue;
    for (std::size_t to = 0; to < kept.size(); ++to) (*column)[to] = (*column)[kept[to]];
    column->resize(kept.size());
  }
  thin.duration_s.assign(kept.size(), 0);
  thin.sample_time_s = 0;
  thin.readings = 0;
  for (std::size_t i = 0; i < thin.size(); ++i) {
    if (i > 0) thin.duration_s[i] = on_grid(thin.time_s[i] - thin.time_s[i - 1]);
    if (std::isfinite(thin.reading_mm[i])) ++thin.readings;
  }
  return thin;
}

namespace {

/// From so much of the largest command on a command that leaves the straight line between two samples jumps.
constexpr double least_jump = 0.01;

/// The command at sample `at`, weighted by a hat over the samples that are dropped on either side.
double hat_mean_kpa(const std::vector<double>& drive_kpa, std::size_t at, std::size_t stride) {
  const double width = static_cast<double>(stride);
  double sum_kpa = drive_kpa[at];
  for (std::size_t j = 1; j < stride; ++j)
    sum_kpa += (1 - static_cast<double>(j) / width) * (drive_kpa[at - j] + drive_kpa[at + j]);
  return sum_kpa / width;
}

/// Whether the command jumps between sample `at` and the next one that is kept.
bool jumps_after(const Record& record, std::size_t at, std::size_t stride) {
  const double from_kpa = record.drive_kpa[at], to_kpa = record.drive_kpa[at + stride];
  for (std::size_t j = 1; j < stride; ++j) {
    const double share = static_cast<double>(j) / static_cast<double>(stride);
    const double straight_kpa = from_kpa + share * (to_kpa - from_kpa);
    if (std::abs(record.drive_kpa[at + j] - straight_kpa) > least_jump * record.largest_kpa) return true;
  }
  return false;
}

/// A jump between two samples that are kept would come up to a whole interval early or late: there the
/// command keeps its mean instead of its value. Corners without a jump stay as sharp as they are.
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

}  // namespace

Record thinned_record(const Record& record, std::size_t stride) {
  std::vector<std::size_t> kept;
  kept.reserve(record.size() / stride + 1);
  for (std::size_t i = 0; i < record.size(); i += stride) kept.push_back(i);
  Record thin = thinned_record(record, kept);
  thin.sample_time_s = record.sample_time_s * static_cast<double>(stride);
  if (stride > 1) keep_mean_of_jumps(record, stride, thin);
  return thin;
}

double fast_noise_mm(const Record& record) {
  return white_noise_of(record.time_s, record.reading_mm);
}

model::Model deterministic_part(const model::Model& model, Drive drive) {
  model::Model part = model;
  std::erase_if(part.blocks, [&](const model::BlockSpec& block) {
    const model::BlockInfo& info = model::catalogue()[block.type].info;
    return model::is<model::SensorNoise, model::Quantisation>(info) ||
           (drive == Drive::measured && info.station == model::Station::valve &&
            !model::is<model::ChamberLag>(info));
  });
  return part;
}

}  // namespace softgrip::sysid
