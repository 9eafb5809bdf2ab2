#include "sysid/diagnosis/residual/outliers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <span>

#include "base/numbers.h"
#include "base/statistics.h"
#include "sysid/diagnosis/residual/noise.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/record.h"
#include "sysid/logs/sensor_codes.h"

namespace softgrip::sysid {
namespace {

/// Smallest distance of an outlier from the median of its four neighbours, in standard deviations of the
/// noise. For a correct reading, the distance has a standard deviation of about 1.15. It exceeds the limit in
/// less than 2 of 10 million readings.
constexpr double beyond = 6.0;

double neighbours_median(const std::vector<double>& y, std::size_t i) {
  std::array<double, 4> near{y[i - 2], y[i - 1], y[i + 1], y[i + 2]};
  std::sort(near.begin(), near.end());
  return 0.5 * (near[1] + near[2]);
}

/// Returns the change of the reading from the two samples before sample `i` to the two samples after it. In a
/// fast motion, this change alone makes a reading deviate from its neighbours. The reading then does not
/// count as an outlier.
double motion(const std::vector<double>& y, std::size_t i) {
  return std::abs(0.5 * (y[i + 1] + y[i + 2]) - 0.5 * (y[i - 1] + y[i - 2]));
}

/// `reach`: largest distance between a reading and its neighbours, in samples. `fewest_neighbours`: smallest
/// number of neighbours on each side.
constexpr std::size_t reach = 3;
constexpr std::size_t fewest_neighbours = 2;
/// Smallest distance of an isolated reading from the median of its neighbours, as a multiple of the spread of
/// the neighbours.
constexpr double alone = 4.0;
/// Uncertainty of the time of a reading [samples]. Its reasons are clocks, latencies and the corners of a
/// motion.
constexpr double timing_samples = 1.5;

/// Median and spread of the neighbours of a reading or of a residual. The spread is the second largest
/// distance from the median, because the neighbour with the largest distance may itself be an outlier.
struct Neighbourhood {
  double median_mm = 0;
  double spread_mm = 0;
  bool known = false;
};

Neighbourhood neighbourhood(const std::vector<double>& r, std::size_t i) {
  std::array<double, 2 * reach> near{};
  std::size_t count = 0, before = 0;
  for (std::size_t j = i < reach ? 0 : i - reach; j <= std::min(i + reach, r.size() - 1); ++j) {
    if (j == i || !std::isfinite(r[j])) continue;
    near[count++] = r[j];
    before += j < i ? 1 : 0;
  }
  Neighbourhood n;
  if (before < fewest_neighbours || count - before < fewest_neighbours) return n;
  const auto end = near.begin() + static_cast<long>(count);
  std::sort(near.begin(), end);
  n.median_mm = 0.5 * (near[(count - 1) / 2] + near[count / 2]);
  for (auto at = near.begin(); at != end; ++at) *at = std::abs(*at - n.median_mm);
  std::sort(near.begin(), end);
  n.spread_mm = near[count - 2];
  n.known = true;
  return n;
}

bool is_outlier(const std::vector<double>& y, std::size_t i, double noise_mm, double& size) {
  size = y[i] - neighbours_median(y, i);
  if (!std::isfinite(size) || std::abs(size) <= beyond * noise_mm || std::abs(size) <= 3 * motion(y, i))
    return false;
  const Neighbourhood near = neighbourhood(y, i);
  return near.known && std::abs(size) > alone * near.spread_mm;
}

/// Returns the largest change of the prediction from one sample to the next, near sample i.
double largest_step(const std::vector<double>& y, const std::vector<double>& r, std::size_t i) {
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
  // Noise alone causes practically no outliers above the limit `beyond`, but a knock on the table can cause a
  // few. Therefore a minimum number of outliers is required.
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
  for (const double value : record.reading_mm) {
    if (std::isfinite(value) && !is_code(value)) others.push_back(value);
  }
  const double usual_mm = median_of(std::span(others));
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double value = record.reading_mm[i];
    if (is_code(value)) hide(record, i, value - usual_mm, evidence);
  }
}

/// The finite readings of a record, with the index of the sample of each reading.
struct Readings {
  std::vector<std::size_t> samples;
  std::vector<double> mm;
};

Readings readings_of(const Record& record) {
  Readings readings;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (!std::isfinite(record.reading_mm[i])) continue;
    readings.samples.push_back(i);
    readings.mm.push_back(record.reading_mm[i]);
  }
  return readings;
}

/// Hides the first two and the last two readings of a record if they are far from all other readings. These
/// readings have too few neighbours for the test of isolated readings. A reading of 0 is never hidden by this
/// function, because a log may begin with the last readings before a step.
void hide_far_ends(Record& record, OutlierEvidence& evidence) {
  constexpr std::size_t ends = 2;
  constexpr double far_outside = 3;
  const Readings readings = readings_of(record);
  const std::size_t count = readings.mm.size();
  if (count < 10 * ends) return;
  const auto [lowest, highest] = std::minmax_element(readings.mm.begin() + ends, readings.mm.end() - ends);
  const double low = std::min(0.0, *lowest), high = std::max(0.0, *highest);
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}, count - 2, count - 1}) {
    const double value = readings.mm[i];
    if (std::max(low - value, value - high) > far_outside * (high - low))
      hide(record, readings.samples[i], value > high ? value - high : value - low, evidence);
  }
}

void hide_isolated(Record& record, double noise_mm, OutlierEvidence& evidence) {
  const Readings readings = readings_of(record);
  for (std::size_t i = 2; i + 2 < readings.mm.size(); ++i) {
    double size = 0;
    if (is_outlier(readings.mm, i, noise_mm, size)) hide(record, readings.samples[i], size, evidence);
  }
}

constexpr std::size_t named_readings = 3;
/// Lower limit of the noise as a share of the span. It is used if the readings contain almost no noise.
constexpr double least_noise_share = 1e-3;

/// Returns the distance from the 5 % quantile to the 95 % quantile of the readings. Single wrong readings do
/// not change this distance.
double usual_span_mm(const Record& record) {
  std::vector<double> sorted;
  std::copy_if(record.reading_mm.begin(), record.reading_mm.end(), std::back_inserter(sorted),
               [](double value) { return std::isfinite(value); });
  if (sorted.empty()) return 0;
  std::sort(sorted.begin(), sorted.end());
  return sorted[sorted.size() - 1 - sorted.size() / 20] - sorted[sorted.size() / 20];
}

double noise_of(const std::vector<Record>& records) {
  double noise_mm = measured_noise_mm(records);
  for (const Record& record : records)
    noise_mm = std::max(noise_mm, least_noise_share * usual_span_mm(record));
  return noise_mm;
}

std::string sentence_of(const Log& log, const std::vector<std::size_t>& wrong) {
  std::string first;
  for (std::size_t i = 0; i < std::min(wrong.size(), named_readings); ++i) {
    first += (i == 0 ? "" : ", ") + significant(log.displacement_mm[wrong[i]]) + " " +
             std::string(model::name_of(log.output_unit)) + " at " + significant(log.time_s[wrong[i]]) + " s";
  }
  if (wrong.size() > named_readings)
    first += " and " + std::to_string(wrong.size() - named_readings) + " more";
  const auto readings = std::count_if(log.displacement_mm.begin(), log.displacement_mm.end(),
                                      [](double value) { return std::isfinite(value); });
  return log.name + ": " + std::to_string(wrong.size()) + " of " + std::to_string(readings) +
         (wrong.size() == 1 ? " readings is an outlier" : " readings are outliers") + ", removed: " + first;
}

}  // namespace

OutlierEvidence hide_outliers(std::vector<Record>& records, double noise_mm) {
  OutlierEvidence evidence;
  for (Record& record : records) {
    evidence.readings += record.readings;
    hide_codes(record, evidence);
    hide_far_ends(record, evidence);
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
      const double size = r[i] - near.median_mm;
      if (!near.known || std::abs(size) <= beyond * noise_mm || std::abs(size) <= alone * near.spread_mm ||
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
