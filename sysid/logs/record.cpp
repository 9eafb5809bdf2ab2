#include "sysid/logs/record.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "base/statistics.h"
#include "model/blocks/chamber_lag.h"
#include "model/blocks/quantisation.h"
#include "model/blocks/sensor_noise.h"
#include "model/catalogue.h"
#include "model/named.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/command_range.h"
#include "sysid/logs/finite_values.h"
#include "sysid/logs/input_smoothing.h"

namespace softgrip::sysid {
namespace {

/// Returns the readings before the drive changes.
std::vector<double> readings_before_motion(const Record& record) {
  const auto moves = std::ranges::find_if(record.drive_kpa, [&](double kpa) {
    return std::abs(kpa - record.drive_kpa.front()) > steady_drive_share * record.largest_kpa;
  });
  const auto still = static_cast<std::size_t>(moves - record.drive_kpa.begin());
  return finite_values(std::span(record.reading_mm).first(still)).values;
}

/// Returns the standard error of the median of several readings [mm], which is sqrt(pi / 2) times the
/// standard error of their mean.
double median_error_mm(const Record& record, std::size_t readings) {
  return std::sqrt(std::numbers::pi / 2 / static_cast<double>(readings)) * fast_noise_mm(record);
}

/// Returns true if no step between neighbouring readings is larger than the first one.
bool begins_with_the_largest_step(const Record& record) {
  const std::vector<double> readings = finite_values(record.reading_mm).values;
  return readings.size() > 2 &&
         std::abs(readings[1] - readings[0]) > largest_step(std::span(readings).subspan(1));
}

/// Returns true if the readings at the beginning show that the zero of the sensor has no offset. The median
/// of the readings before the drive changes must not differ significantly from 0, so that a single wrong
/// reading does not determine the offset. If there is at most one such reading, the step from the first to
/// the second reading must not be larger than all other steps.
bool begins_at_zero(const Record& record) {
  const double tolerance_mm = 1e-3 * record.span_mm;
  std::vector<double> readings = readings_before_motion(record);
  if (readings.size() > 1)
    return std::abs(median_of(std::span(readings))) <
           std::max(4 * median_error_mm(record, readings.size()), tolerance_mm);
  const auto first = std::find_if(record.reading_mm.begin(), record.reading_mm.end(),
                                  [](double y) { return std::isfinite(y); });
  return first != record.reading_mm.end() && !begins_with_the_largest_step(record) &&
         std::abs(*first) < std::max(4 * fast_noise_mm(record), tolerance_mm);
}

/// Returns true if the record begins with a rest almost without pressure: the drive stays constant for 20
/// readings, and the readings are steady. A converter or a pressure sensor with an offset shows a small
/// pressure at such a rest.
bool rests_almost_without_pressure(const Record& record) {
  if (std::abs(record.drive_kpa.front()) > limits::rest_share * record.largest_kpa) return false;
  std::vector<double> readings = readings_before_motion(record);
  if (readings.size() < limits::fewest_events) return false;
  const std::size_t half = readings.size() / 2;
  const double change_mm =
      median_of(std::span(readings).last(half)) - median_of(std::span(readings).first(half));
  return std::abs(change_mm) < std::max(4 * std::numbers::sqrt2 * median_error_mm(record, half),
                                        limits::negligible_share * record.span_mm);
}

Record make_record(const Log& log, const RecordOptions& options, double campaign_time_s) {
  Record record;
  record.name = log.name;
  record.output_unit = log.output_unit;
  record.drive = options.drive;
  record.time_s = log.time_s;
  record.drive_kpa = options.drive == Drive::measured ? log.pressure_kpa : log.pressure_command_kpa;
  record.reading_mm = log.displacement_mm;
  record.temperature_c = log.temperature_c;
  record.supply_kpa = log.supply_kpa;
  record.campaign_time_s = campaign_time_s;
  record.held = options.held;
  record.span_mm = span_mm(log);
  if (options.drive == Drive::measured) static_cast<void>(smooth_input(record.time_s, record.drive_kpa));
  for (auto* column : {&record.temperature_c, &record.supply_kpa})
    static_cast<void>(smooth_input(record.time_s, *column));
  for (auto* column : {&record.drive_kpa, &record.temperature_c, &record.supply_kpa}) fill_missing(*column);
  record.duration_s.resize(record.size());
  for (std::size_t i = 1; i < record.size(); ++i)
    record.duration_s[i] = step_duration_s(log.time_s[i] - log.time_s[i - 1]);
  record.finest_interval_s = record.mean_interval_s();
  const Sampling sampling = sampling_of(log);
  const double nominal = step_duration_s(sampling.median_interval_s);
  const double worst =
      std::max(sampling.longest_interval_s - nominal, nominal - sampling.shortest_interval_s);
  if (worst < 1e-9 * nominal + 2e-12) record.sample_time_s = nominal;
  for (const double p : record.drive_kpa) record.largest_kpa = std::max(record.largest_kpa, std::abs(p));
  record.readings = finite_count(record.reading_mm);
  record.start = options.start;
  const bool pressurised = std::abs(record.drive_kpa.front()) > steady_drive_share * record.largest_kpa;
  record.start_unknown =
      options.start == Start::unknown ||
      (options.start == Start::automatic && pressurised && !rests_almost_without_pressure(record));
  record.offset_free = record.start_unknown || pressurised || !begins_at_zero(record);
  return record;
}

}  // namespace

std::string name_of(Drive drive) {
  return drive == Drive::measured ? "measured pressure" : "command";
}

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

std::size_t reading_count(const std::vector<Record>& records) {
  std::size_t count = 0;
  for (const Record& record : records) count += record.readings;
  return count;
}

double time_unit_s(double interval_s, double length_s) {
  constexpr double intervals = 10, share = 0.5;
  const bool resolves_1_s = intervals * interval_s <= 1 && share * length_s >= 1;
  return resolves_1_s || !(length_s > 0) ? 1 : std::sqrt(interval_s * length_s);
}

double time_unit_s(const std::vector<Record>& records) {
  double interval_s = std::numeric_limits<double>::infinity(), length_s = 0;
  for (const Record& record : records) {
    if (record.size() < 2 || !(record.finest_interval_s > 0)) continue;
    interval_s = std::min(interval_s, step_duration_s(record.finest_interval_s));
    length_s = std::max(length_s, record.length_s());
  }
  return time_unit_s(interval_s, length_s);
}

double pressure_unit_kpa(const std::vector<Record>& records) {
  constexpr double least_of_a_finger_kpa = 20;
  const double largest_kpa = campaign_size(records).largest_kpa;
  return largest_kpa > 0 ? std::min(1.0, largest_kpa / least_of_a_finger_kpa) : 1;
}

double displacement_unit_mm(const std::vector<Record>& records) {
  constexpr double smallest_of_a_finger_mm = 1, largest_of_a_finger_mm = 40;
  const double span_mm = campaign_size(records).span_mm;
  if (span_mm > 0 && span_mm < smallest_of_a_finger_mm) return span_mm / smallest_of_a_finger_mm;
  return std::max(1.0, span_mm / largest_of_a_finger_mm);
}

void hide_reading(Record& record, std::size_t sample) {
  if (!std::isfinite(record.reading_mm[sample])) return;
  record.reading_mm[sample] = std::numeric_limits<double>::quiet_NaN();
  --record.readings;
}

double step_duration_s(double duration_s) {
  return std::round(duration_s * 1e12) * 1e-12;
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

CampaignSize campaign_size(const std::vector<Record>& records) {
  CampaignSize extent;
  for (const Record& record : records) {
    extent.largest_kpa = std::max(extent.largest_kpa, record.largest_kpa);
    extent.span_mm = std::max(extent.span_mm, record.span_mm);
    extent.longest_s = std::max(extent.longest_s, record.length_s());
  }
  return extent;
}

}  // namespace softgrip::sysid
