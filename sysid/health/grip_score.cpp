#include "sysid/health/grip_score.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "base/statistics.h"
#include "sysid/fitting/fit_space.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid::health {
namespace {

using sysid::HealthNumber;

/// Smallest range and smallest RMS speed of a motion from which gain and lag are computed. The range is a
/// share of the displacement at full pressure. The speed is a share of this displacement per second.
constexpr double least_motion = 0.1;
constexpr double least_speed_per_s = 0.02;
/// A motion has a direction only if its speed is at least this value [share of the displacement at full
/// pressure, per second].
constexpr double still_per_s = 0.01;
/// The loop width is computed only from a return with at least this speed [share of the displacement at full
/// pressure, per second]. Slower samples are creep towards rest.
constexpr double returning_per_s = 0.05;
/// Shortest durations of the samples of an indicator, for each part of the recording [s]. With fewer samples,
/// the indicator is not computed.
constexpr double least_rest_s = 0.1;
constexpr double least_motion_s = 0.5;
constexpr double least_return_s = 0.03;
constexpr double least_hold_s = 1.0;
/// The contact indicator is computed from the readings up to this time after contact [s].
constexpr double touch_window_s = 0.1;
/// The creep, the pressure loss and the leak are not computed from the samples in this time after a change of
/// the command, because the valve is still settling [s].
constexpr double settling_s = 0.3;
/// The loop width is computed from the samples whose predicted displacement is between these shares of
/// FreeFit::way_mm.
constexpr double loop_lower = 0.15, loop_upper = 1 - loop_lower;

/// Samples of a run, and the prediction of the baseline model for each sample.
struct Compared {
  const sysid::Log& log;
  std::vector<double> predicted_mm, speed_mm_per_s;
  GripParts parts;
  /// Direction of the last predicted motion: 1 up, -1 down, 0 if there was no motion before.
  std::vector<int> direction;
  double interval_s = 0;

  [[nodiscard]] bool is_read(std::size_t i) const { return std::isfinite(log.displacement_mm[i]); }
};

std::vector<double> speed_of(const std::vector<double>& y, const std::vector<double>& t) {
  std::vector<double> speed(y.size(), 0.0);
  for (std::size_t i = 1; i + 1 < y.size(); ++i) speed[i] = (y[i + 1] - y[i - 1]) / (t[i + 1] - t[i - 1]);
  return speed;
}

Compared compare(const Recording& recording, std::size_t channel, const ScoreBase& base) {
  const sysid::Log& log = recording.channels[channel];
  const std::vector<sysid::Record> records =
      sysid::make_records({log}, {.start = sysid::Start::rest, .held = true});
  Compared c{
      log, sysid::predict(base.model, records.front(), sysid::rest_starts(base.model, records).front()),
      {},  {},
      {},  records.front().mean_interval_s()};
  c.speed_mm_per_s = speed_of(c.predicted_mm, log.time_s);
  c.parts = parts_of(recording, channel, c.predicted_mm, base.full_kpa, base.full_mm);
  int direction = 0;
  for (const double speed : c.speed_mm_per_s) {
    if (std::abs(speed) > still_per_s * base.full_mm) direction = speed > 0 ? 1 : -1;
    c.direction.push_back(direction);
  }
  return c;
}

double median_or_nan(std::vector<double> values, double least_count) {
  if (values.empty() || static_cast<double>(values.size()) < least_count)
    return std::numeric_limits<double>::quiet_NaN();
  return median_of(std::span<double>(values));
}

double zero_of(const Compared& c) {
  std::vector<double> zeros;
  for (std::size_t i = 0; i < c.log.size(); ++i) {
    if (c.parts.at[i] == Part::rest && c.is_read(i))
      zeros.push_back(c.log.displacement_mm[i] - c.predicted_mm[i]);
  }
  return median_or_nan(std::move(zeros), least_rest_s / c.interval_s);
}

/// Least-squares fit to the readings of free motion: offset + gain * prediction - lag * predicted speed.
struct FreeFit {
  double offset_mm = 0, gain = 1, lag_s = 0;
  double way_mm = 0;  ///< range of the predicted displacement [mm]
  double speed_rms_mm_per_s = 0;
  double seconds = 0;

  [[nodiscard]] double left(const Compared& c, std::size_t i) const {
    return c.log.displacement_mm[i] - offset_mm - gain * c.predicted_mm[i] + lag_s * c.speed_mm_per_s[i];
  }
};

FreeFit fit_free(const Compared& c, const ScoreBase& base) {
  FreeFit fit;
  Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  double lowest = 0, highest = 0, squares = 0, count = 0;
  for (std::size_t i = 0; i < c.log.size(); ++i) {
    const bool up = c.parts.at[i] == Part::rest || (c.parts.at[i] == Part::free && c.direction[i] >= 0);
    if (!up || !c.is_read(i)) continue;
    const Eigen::Vector3d row(base.full_mm, c.predicted_mm[i], -c.speed_mm_per_s[i]);
    gram += row * row.transpose();
    moment += row * c.log.displacement_mm[i];
    lowest = std::min(lowest, c.predicted_mm[i]);
    highest = std::max(highest, c.predicted_mm[i]);
    squares += c.speed_mm_per_s[i] * c.speed_mm_per_s[i];
    count += 1;
  }
  if (count == 0) return fit;
  fit.way_mm = highest - lowest;
  fit.seconds = count * c.interval_s;
  fit.speed_rms_mm_per_s = std::sqrt(squares / count);
  const Eigen::Vector3d solution = gram.ldlt().solve(moment);
  if (fit.way_mm < least_motion * base.full_mm || !solution.allFinite()) return fit;
  fit.offset_mm = solution[0] * base.full_mm;
  fit.gain = solution[1];
  fit.lag_s = solution[2];
  return fit;
}

double loop_of(const Compared& c, const FreeFit& fit, double full_mm) {
  std::vector<double> higher;
  for (std::size_t i = 0; i < c.log.size(); ++i) {
    const double share = c.predicted_mm[i] / fit.way_mm;
    if (c.parts.at[i] == Part::free && c.is_read(i) && share > loop_lower && share < loop_upper &&
        c.speed_mm_per_s[i] < -returning_per_s * full_mm)
      higher.push_back(fit.left(c, i));
  }
  return median_or_nan(std::move(higher), least_return_s / c.interval_s);
}

/// Consecutive samples [first, last) that belong to the same part of a grip and have a constant command.
struct Stretch {
  std::size_t first = 0, last = 0;
};

double length_s(const Compared& c, const Stretch& stretch) {
  return stretch.last > stretch.first ? c.log.time_s[stretch.last - 1] - c.log.time_s[stretch.first] : 0;
}

/// Returns the longest segment of samples that belong to `part` and have a constant command. The first
/// `settling_s` seconds of the segment are excluded.
Stretch longest_still(const Compared& c, Part part, double full_kpa) {
  Stretch best;
  for (std::size_t begin = 0; begin < c.log.size();) {
    if (c.parts.at[begin] != part) {
      ++begin;
      continue;
    }
    std::size_t end = begin;
    while (end < c.log.size() && c.parts.at[end] == part &&
           std::abs(c.log.pressure_command_kpa[end] - c.log.pressure_command_kpa[begin]) <=
               limits::constant_command_share * full_kpa)
      ++end;
    Stretch found{begin, end};
    while (found.first < end && c.log.time_s[found.first] < c.log.time_s[begin] + settling_s) ++found.first;
    if (length_s(c, found) > length_s(c, best)) best = found;
    begin = end;
  }
  return best;
}

/// Returns the creep that the prediction does not contain. This creep is the change of the residual from the
/// first fifth to the last fifth of the longest segment with a constant command. It is positive in the
/// direction of the motion before this segment.
double creep_of(const Compared& c, const FreeFit& fit, double full_kpa) {
  const Stretch still = longest_still(c, Part::free, full_kpa);
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  if (length_s(c, still) < least_motion_s || c.direction[still.first] == 0) return nothing;
  const std::size_t fifth = (still.last - still.first) / 5;
  std::vector<double> early, late;
  for (std::size_t i = still.first; i < still.last; ++i) {
    if (!c.is_read(i)) continue;
    if (i < still.first + fifth) early.push_back(fit.left(c, i));
    if (i >= still.last - fifth) late.push_back(fit.left(c, i));
  }
  return (median_or_nan(std::move(late), 2) - median_or_nan(std::move(early), 2)) * c.direction[still.first];
}

void score_line(const Compared& c, double full_kpa, GripScore& score) {
  if (c.log.pressure_kpa.empty()) return;
  const Stretch hold = longest_still(c, Part::held, full_kpa);
  if (length_s(c, hold) < least_hold_s) return;
  PairSums sums;
  for (std::size_t i = hold.first; i < hold.last; ++i)
    sums.add(c.log.time_s[i], c.log.pressure_command_kpa[i] - c.log.pressure_kpa[i]);
  if (sums.count * c.interval_s < least_hold_s / 2) return;
  score[HealthNumber::pressure_loss] = sums.y / sums.count;
  score[HealthNumber::leak] = sums.slope();
}

double contact_of(const Compared& c) {
  std::vector<double> readings;
  for (std::size_t i = 0; i < c.log.size(); ++i) {
    const double after_s = c.log.time_s[i] - c.parts.contact_s;
    if (after_s >= 0 && after_s < touch_window_s && c.is_read(i))
      readings.push_back(c.log.displacement_mm[i]);
  }
  return median_or_nan(std::move(readings), 2);
}

}  // namespace

ScoreBase score_base(const model::Model& model, double full_kpa) {
  ScoreBase base{sysid::deterministic_part(model, sysid::Drive::command), full_kpa, 0};
  constexpr double interval_s = 0.02, rise_s = 2;
  constexpr int intervals = 500;
  sysid::Log log;
  for (int i = 0; i <= intervals; ++i) {
    const double t = i * interval_s;
    log.time_s.push_back(t);
    log.pressure_command_kpa.push_back(full_kpa * std::min(1.0, t / rise_s));
    log.displacement_mm.push_back(0);
  }
  const std::vector<sysid::Record> records = sysid::make_records({log}, {.start = sysid::Start::rest});
  const std::vector<double> predicted =
      sysid::predict(base.model, records.front(), sysid::rest_starts(base.model, records).front());
  base.full_mm = predicted.back() - predicted.front();
  return base;
}

GripScore score_of(const Recording& recording, std::size_t channel, const ScoreBase& base) {
  GripScore score;
  if (recording.channels[channel].size() < 3) return score;
  const Compared c = compare(recording, channel, base);
  const FreeFit fit = fit_free(c, base);
  score[HealthNumber::zero] = zero_of(c);
  if (fit.way_mm >= least_motion * base.full_mm && fit.seconds >= least_motion_s) {
    score[HealthNumber::gain] = fit.gain * base.full_mm;
    if (fit.speed_rms_mm_per_s >= least_speed_per_s * base.full_mm) score[HealthNumber::lag] = fit.lag_s;
    score[HealthNumber::loop_width] = loop_of(c, fit, base.full_mm);
    score[HealthNumber::creep] = creep_of(c, fit, base.full_kpa);
  }
  score_line(c, base.full_kpa, score);
  score[HealthNumber::contact] = contact_of(c);
  score[HealthNumber::time_to_grip] = c.parts.holding_s - c.parts.began_s;
  return score;
}

double least_difference(HealthNumber number, const ScoreBase& base) {
  constexpr double share_of_way = 0.0005, share_of_pressure = 0.001;
  switch (number) {
    case HealthNumber::gain:
      return 4 * share_of_way * base.full_mm;
    case HealthNumber::zero:
    case HealthNumber::creep:
    case HealthNumber::loop_width:
    case HealthNumber::contact:
      return share_of_way * base.full_mm;
    case HealthNumber::lag:
      return 0.002;
    case HealthNumber::pressure_loss:
      return share_of_pressure * base.full_kpa;
    case HealthNumber::leak:
      return 0.2 * share_of_pressure * base.full_kpa;
    case HealthNumber::time_to_grip:
      return 0.01;
  }
  return 0;
}

}  // namespace softgrip::sysid::health
