#include "sysid/fitting/score.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "base/numbers.h"
#include "base/statistics.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/logs/finite_values.h"

namespace softgrip::sysid {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

/// An excursion of the pressure: the interval in which the pressure rises from rest and returns to rest.
struct Excursion {
  std::size_t begin;
  double peak_kpa;
  double duration_s;
};

std::vector<Excursion> excursions_of(const Record& record) {
  const auto [low, high] = std::minmax_element(record.drive_kpa.begin(), record.drive_kpa.end());
  const double threshold = *low + 0.03 * (*high - *low);
  std::vector<Excursion> excursions;
  bool out = false;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double p = record.drive_kpa[i];
    if (p > threshold && !out) excursions.push_back({i, p, 0});
    out = p > threshold;
    if (excursions.empty()) continue;
    Excursion& last = excursions.back();
    if (out) last.peak_kpa = std::max(last.peak_kpa, p);
    if (out) last.duration_s = record.time_s[i] - record.time_s[last.begin];
  }
  return excursions;
}

bool alike(const Excursion& a, const Excursion& b) {
  return std::abs(a.peak_kpa - b.peak_kpa) < 0.03 * std::max(a.peak_kpa, b.peak_kpa) &&
         std::abs(a.duration_s - b.duration_s) < 0.05 * std::max(a.duration_s, b.duration_s) + 0.1;
}

}  // namespace

std::vector<std::size_t> cycle_starts(const Record& record) {
  const std::vector<Excursion> excursions = excursions_of(record);
  std::size_t period = 1;
  for (std::size_t m = 1; 2 * m <= excursions.size(); ++m) {
    bool repeats = true;
    for (std::size_t i = 0; i + m < excursions.size() && repeats; ++i)
      repeats = alike(excursions[i], excursions[i + m]);
    if (!repeats) continue;
    period = m;
    break;
  }
  std::vector<std::size_t> starts{0};
  for (std::size_t i = period; i < excursions.size(); i += period) starts.push_back(excursions[i].begin);
  return starts;
}

namespace {

constexpr double a_multiple = 0.9;

bool diverges(const Score& score, const std::vector<double>& readings, double span_mm) {
  PairSums sums;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (!std::isfinite(score.prediction_mm[i])) return true;
    sums.add(score.prediction_mm[i], readings[i]);
  }
  return span_mm > 0 && score.rmse_mm > span_mm && std::abs(sums.correlation()) < a_multiple;
}

}  // namespace

Score score_of(const model::Model& model, const Record& record, const StartState& start,
               const std::vector<double>& readings) {
  Score score;
  score.name = record.name;
  score.output_unit = record.output_unit;
  score.drive = record.drive;
  score.start = start;
  score.prediction_mm = predict(model, record, start);
  score.error_mm.resize(record.size());
  for (std::size_t i = 0; i < record.size(); ++i) {
    score.error_mm[i] = readings[i] - score.prediction_mm[i];
    if (!std::isfinite(readings[i])) continue;
    const double size_mm = std::abs(score.error_mm[i]);
    score.largest_error_mm = std::max(score.largest_error_mm, std::isfinite(size_mm) ? size_mm : infinite);
  }
  const std::span<const double> read(readings), errors(score.error_mm);
  score.rmse_mm = rms_error(read, errors);
  score.rmse_percent_of_span = record.span_mm > 0 ? 100 * score.rmse_mm / record.span_mm : none;
  const std::vector<std::size_t> cycles = cycle_starts(record);
  if (cycles.size() > 1) {
    const auto rmse_of = [](std::span<const double> part, std::span<const double> part_errors) {
      return finite_count(part) > 0 ? rms_error(part, part_errors) : none;
    };
    score.first_cycle_rmse_mm = rmse_of(read.first(cycles[1]), errors.first(cycles[1]));
    score.settled_rmse_mm = rmse_of(read.subspan(cycles[1]), errors.subspan(cycles[1]));
  } else {
    score.first_cycle_rmse_mm = score.settled_rmse_mm = none;
  }
  score.diverges = diverges(score, readings, record.span_mm);
  return score;
}

std::vector<std::string> divergences_of(const std::vector<Score>& scores) {
  std::vector<std::string> sentences;
  for (const Score& score : scores) {
    if (!score.diverges) continue;
    const bool finite = std::all_of(score.prediction_mm.begin(), score.prediction_mm.end(),
                                    [](double value) { return std::isfinite(value); });
    sentences.push_back("the prediction of " + score.name + " diverges, because the prediction " +
                        (finite ? "deviates from the readings by up to " +
                                      significant(score.largest_error_mm, 3) + " " +
                                      std::string(model::name_of(score.output_unit))
                                : std::string("is not finite")));
  }
  return sentences;
}

}  // namespace softgrip::sysid
