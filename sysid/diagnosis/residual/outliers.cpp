#include "sysid/diagnosis/residual/outliers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "base/numbers.h"
#include "base/statistics.h"
#include "sysid/diagnosis/residual/noise.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/command_range.h"
#include "sysid/logs/finite_values.h"
#include "sysid/logs/isolated_values.h"
#include "sysid/logs/record.h"
#include "sysid/logs/sensor_codes.h"

namespace softgrip::sysid {
namespace {

/// Uncertainty of the time of a reading [samples]. Its reasons are clocks, latencies and the corners of a
/// motion.
constexpr double timing_samples = 1.5;

/// Returns the largest change of the prediction from one sample to the next, near sample i.
double largest_step(const std::vector<double>& y, const std::vector<double>& r, std::size_t i) {
  constexpr std::size_t reach = isolated_reach;
  double largest = 0;
  for (std::size_t j = i < reach ? 1 : i - reach + 1; j <= std::min(i + reach, r.size() - 1); ++j) {
    const double step = std::abs((y[j] - r[j]) - (y[j - 1] - r[j - 1]));
    if (std::isfinite(step)) largest = std::max(largest, step);
  }
  return largest;
}

void weigh(OutlierEvidence& evidence, double noise_mm) {
  evidence.count = evidence.sizes_mm.size();
  if (evidence.count == 0) return;
  double square = 0, fourth = 0;
  for (const double size : evidence.sizes_mm) {
    square += size * size;
    fourth += size * size * size * size;
  }
  const auto count = static_cast<double>(evidence.count);
  const auto all = static_cast<double>(evidence.readings);
  evidence.share = count / all;
  evidence.size_mm = std::sqrt(square / count);
  evidence.excess_mm = std::sqrt(square / all);
  constexpr double z = limits::deviate;
  const double middle = (evidence.share + z * z / (2 * all)) / (1 + z * z / all);
  const double half = z / (1 + z * z / all) *
                      std::sqrt(evidence.share * (1 - evidence.share) / all + z * z / (4 * all * all));
  evidence.share_low = middle - half;
  evidence.share_high = middle + half;
  const double deviation = std::sqrt(std::max(0.0, fourth / count - square / count * square / count) / count);
  evidence.size_low_mm = std::sqrt(std::max(0.0, square / count - z * deviation));
  evidence.size_high_mm = std::sqrt(square / count + z * deviation);
  // Noise alone causes practically no outliers above the limit `isolated_beyond`, but a knock on the table
  // can cause a few. Therefore a minimum number of outliers is required.
  evidence.distorts = evidence.excess_mm > limits::hidden_by_noise * noise_mm;
  evidence.present = evidence.count >= limits::fewest_occurrences && evidence.distorts;
}

void hide(Record& record, std::size_t i, double size_mm, OutlierEvidence& evidence) {
  hide_reading(record, i);
  evidence.sizes_mm.push_back(size_mm);
}

void hide_codes(Record& record, OutlierEvidence& evidence) {
  const std::vector<double> codes = sensor_codes(record.reading_mm);
  if (codes.empty()) return;
  const auto is_code = [&](double value) { return std::binary_search(codes.begin(), codes.end(), value); };
  std::vector<double> others;
  for (const double value : finite_values(record.reading_mm).values) {
    if (!is_code(value)) others.push_back(value);
  }
  const double usual_mm = median_of(std::span(others));
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double value = record.reading_mm[i];
    if (is_code(value)) hide(record, i, value - usual_mm, evidence);
  }
}

/// Hides the first two and the last two readings of a record if they are far from all other readings. These
/// readings have too few neighbours for the test of isolated readings. A reading of 0 is never hidden by this
/// function, because a log may begin with the last readings before a step.
void hide_far_ends(Record& record, OutlierEvidence& evidence) {
  constexpr std::size_t ends = 2;
  const FiniteValues readings = finite_values(record.reading_mm);
  const std::size_t count = readings.values.size();
  if (count < 10 * ends) return;
  const auto [lowest, highest] =
      std::minmax_element(readings.values.begin() + ends, readings.values.end() - ends);
  const double low = std::min(0.0, *lowest), high = std::max(0.0, *highest);
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}, count - 2, count - 1}) {
    const double value = readings.values[i];
    if (std::max(low - value, value - high) > far_outside * (high - low))
      hide(record, readings.samples[i], value > high ? value - high : value - low, evidence);
  }
}

/// Hides the first and the last reading if they are isolated: far from the four readings beside them, while
/// neither these readings nor the pressure change. A sensor may deliver its last value from before the start.
void hide_isolated_ends(Record& record, double noise_mm, OutlierEvidence& evidence) {
  constexpr std::size_t beside = 4;
  const FiniteValues readings = finite_values(record.reading_mm);
  const std::size_t count = readings.values.size();
  if (count < 10 * beside) return;
  for (const bool first : {true, false}) {
    const auto place = [&](std::size_t k) { return first ? k : count - 1 - k; };
    std::array<double, beside> near{};
    double low_kpa = record.drive_kpa[readings.samples[place(0)]], high_kpa = low_kpa;
    for (std::size_t k = 0; k < beside; ++k) {
      near[k] = readings.values[place(k + 1)];
      const double drive_kpa = record.drive_kpa[readings.samples[place(k + 1)]];
      low_kpa = std::min(low_kpa, drive_kpa);
      high_kpa = std::max(high_kpa, drive_kpa);
    }
    if (high_kpa - low_kpa > steady_drive_share * record.largest_kpa) continue;
    const auto [lowest, highest] = std::minmax_element(near.begin(), near.end());
    const double spread_mm = *highest - *lowest;
    const double distance_mm = readings.values[place(0)] - median_of(std::span<double>(near));
    if (std::abs(distance_mm) > isolated_beyond * noise_mm &&
        std::abs(distance_mm) > isolated_alone * spread_mm)
      hide(record, readings.samples[place(0)], distance_mm, evidence);
  }
}

void hide_isolated(Record& record, double noise_mm, OutlierEvidence& evidence) {
  for (const IsolatedValue& found : isolated_values(record.reading_mm, noise_mm))
    hide(record, found.sample, found.distance, evidence);
}

double noise_of(const std::vector<Record>& records) {
  double noise_mm = measured_noise_mm(records);
  for (const Record& record : records)
    noise_mm = std::max(noise_mm, least_noise_share * usual_span(record.reading_mm));
  return noise_mm;
}

std::string sentence_of(const Log& log, const std::vector<std::size_t>& wrong) {
  return log.name + ": " + std::to_string(wrong.size()) + " of " +
         std::to_string(finite_count(log.displacement_mm)) +
         (wrong.size() == 1 ? " readings is an outlier" : " readings are outliers") +
         ", removed: " + listed(log.displacement_mm, log.time_s, wrong, model::name_of(log.output_unit));
}

}  // namespace

OutlierEvidence hide_outliers(std::vector<Record>& records, double noise_mm) {
  OutlierEvidence evidence;
  for (Record& record : records) {
    evidence.readings += record.readings;
    hide_codes(record, evidence);
    hide_far_ends(record, evidence);
    hide_isolated_ends(record, noise_mm, evidence);
    hide_isolated(record, noise_mm, evidence);
  }
  weigh(evidence, noise_mm);
  return evidence;
}

std::size_t hide_outliers_beside(std::vector<Record>& records,
                                 const std::vector<std::vector<double>>& residual_mm, double noise_mm,
                                 OutlierEvidence& evidence) {
  std::size_t hidden = 0;
  for (std::size_t k = 0; k < records.size(); ++k) {
    const std::vector<double>& r = residual_mm[k];
    const std::vector<double> y = records[k].reading_mm;
    for (std::size_t i = 0; i < r.size(); ++i) {
      if (!std::isfinite(r[i]) || !std::isfinite(y[i])) continue;
      const Neighbourhood near = neighbourhood(r, i);
      const double size = r[i] - near.median;
      if (!near.known || std::abs(size) <= isolated_beyond * noise_mm ||
          std::abs(size) <= isolated_alone * near.spread ||
          std::abs(size) <= timing_samples * largest_step(y, r, i)) {
        continue;
      }
      hide(records[k], i, size, evidence);
      ++hidden;
    }
  }
  if (hidden > 0) weigh(evidence, noise_mm);
  return hidden;
}

std::vector<std::string> take_out_wrong_readings(std::vector<Log>& logs) {
  std::vector<Record> records = make_records(logs, {});
  const std::vector<Record> before = records;
  const OutlierEvidence evidence = hide_outliers(records, noise_of(records));
  std::vector<std::string> sentences;
  if (!evidence.distorts) return sentences;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    std::vector<std::size_t> wrong;
    for (std::size_t i = 0; i < logs[k].size(); ++i) {
      if (std::isfinite(before[k].reading_mm[i]) && !std::isfinite(records[k].reading_mm[i]))
        wrong.push_back(i);
    }
    if (wrong.empty()) continue;
    sentences.push_back(sentence_of(logs[k], wrong));
    for (const std::size_t i : wrong) logs[k].displacement_mm[i] = std::numeric_limits<double>::quiet_NaN();
  }
  return sentences;
}

}  // namespace softgrip::sysid
