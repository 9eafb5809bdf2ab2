#include "sysid/diagnosis/residual/wrong_readings.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>

#include "base/numbers.h"
#include "sysid/diagnosis/residual/noise.h"
#include "sysid/diagnosis/residual/outliers.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {
namespace {

constexpr std::size_t named_readings = 3;
/// Lower limit of the noise as a share of the span. It applies to readings that contain almost no noise.
constexpr double least_noise_share = 1e-3;

/// Returns the range between the 5 % and the 95 % quantile of the readings. Wrong readings do not affect this
/// range.
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
