#include "sysid/changes/change_intervals.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>

#include "base/statistics.h"
#include "sysid/changes/change_search.h"
#include "sysid/changes/change_size.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// A parameter of an effect, and the step that its numerical derivative uses.
struct Place {
  std::size_t effect = 0, number = 0;
  double by = 0;
};

std::vector<Place> places_of(const std::vector<FittedEffect>& found) {
  std::vector<Place> places;
  for (std::size_t e = 0; e < found.size(); ++e) {
    for (std::size_t k = 0; k < found[e].numbers.size(); ++k)
      places.push_back({e, k, small_move(found[e], k)});
  }
  return places;
}

std::vector<FittedEffect> moved(std::vector<FittedEffect> found, const Place& place) {
  found[place.effect].numbers[place.number] += place.by;
  return found;
}

/// Returns the differences of white_and_gain() that result from one step of each parameter. `places` contains
/// the steps.
Eigen::MatrixXd slopes_of(const LaterReadings& readings, const std::vector<FittedEffect>& found,
                          const std::vector<Place>& places, const Eigen::VectorXd& white) {
  Eigen::MatrixXd slopes(white.size(), static_cast<Eigen::Index>(places.size()));
  for (std::size_t c = 0; c < places.size(); ++c)
    slopes.col(static_cast<Eigen::Index>(c)) = readings.white_and_gain(moved(found, places[c])) - white;
  return slopes;
}

/// Returns the covariance of the gradient: the sum of the outer products of the gradients of all blocks. The
/// penalty rows follow the rows of the readings. Each penalty row counts as a separate block with variance 1.
Eigen::MatrixXd spread_of_gradient(const LaterReadings& readings, const Eigen::MatrixXd& slopes,
                                   const Eigen::VectorXd& white) {
  const std::vector<std::size_t> blocks = blocks_of(readings);
  const std::size_t count = blocks.empty() ? 0 : blocks.back() + 1;
  const auto beyond = static_cast<std::size_t>(white.size()) - blocks.size();
  Eigen::MatrixXd gradients = Eigen::MatrixXd::Zero(slopes.cols(), static_cast<Eigen::Index>(count + beyond));
  for (Eigen::Index i = 0; i < white.size(); ++i) {
    const auto row = static_cast<std::size_t>(i);
    const std::size_t block = row < blocks.size() ? blocks[row] : count + row - blocks.size();
    gradients.col(static_cast<Eigen::Index>(block)) +=
        slopes.row(i).transpose() * (row < blocks.size() ? white(i) : 1);
  }
  const auto n = static_cast<double>(count), numbers = static_cast<double>(slopes.cols());
  // Corrects for the degrees of freedom: number of blocks minus number of parameters.
  const double few = n > numbers ? n / (n - numbers) : 1;
  return few * gradients * gradients.transpose();
}

/// Returns the factorised curvature of the sum of squares. A parameter that has no effect on the readings has
/// zero derivatives and does not contribute.
Eigen::LDLT<Eigen::MatrixXd> curvature_of(const Eigen::MatrixXd& slopes) {
  Eigen::MatrixXd curvature = slopes.transpose() * slopes;
  curvature.diagonal().array() += 1e-12 * (1 + curvature.trace());
  return Eigen::LDLT<Eigen::MatrixXd>(curvature);
}

/// Returns the covariance of the parameters in units of their steps.
Eigen::MatrixXd covariance_of(const LaterReadings& readings, const Eigen::MatrixXd& slopes,
                              const Eigen::VectorXd& white) {
  const Eigen::LDLT<Eigen::MatrixXd> solver = curvature_of(slopes);
  return solver.solve(solver.solve(spread_of_gradient(readings, slopes, white)).transpose());
}

/// Returns the covariance of the parameters in units of their steps, from the differences between the later
/// runs: the sandwich estimator whose blocks are the runs. The readings of a run are not independent, because
/// an error of the model or a difference of this run affects all of them.
Eigen::MatrixXd covariance_between_runs(const LaterReadings& readings, const Eigen::MatrixXd& slopes,
                                        const Eigen::VectorXd& white) {
  const auto runs = static_cast<Eigen::Index>(readings.records().size());
  Eigen::MatrixXd gradients = Eigen::MatrixXd::Zero(slopes.cols(), runs);
  Eigen::Index row = 0;
  for (const WhiteRows::Row& each : readings.rows().rows()) {
    gradients.col(static_cast<Eigen::Index>(each.record)) += slopes.row(row).transpose() * white(row);
    ++row;
  }
  gradients.colwise() -= gradients.rowwise().mean().eval();
  const Eigen::LDLT<Eigen::MatrixXd> solver = curvature_of(slopes);
  const Eigen::MatrixXd moves = solver.solve(gradients);
  const auto n = static_cast<double>(runs);
  return n / (n - 1) * moves * moves.transpose();
}

/// Deviation of the parameters in a healthy unit, which was left out of the fit, in units of their steps. In
/// the unit, nothing has changed, so the deviation is an error of the baseline model or a difference between
/// runs. One linear step from the values that were found in the later readings gives the deviation. The step
/// has no bounds and no penalty, so small deviations of either sign count.
struct Deviation {
  Eigen::VectorXd steps;
  Eigen::MatrixXd covariance;  ///< of `steps`, if the whitened readings of the unit contain only noise
};

Deviation deviation_in(const LaterReadings& unit, const std::vector<FittedEffect>& found,
                       const std::vector<Place>& places) {
  const Eigen::MatrixXd slopes = slopes_of(unit, found, places, unit.white_and_gain(found));
  const Eigen::VectorXd white = unit.white_and_gain({});
  const Eigen::LDLT<Eigen::MatrixXd> solver = curvature_of(slopes);
  return {solver.solve(slopes.transpose() * white),
          solver.solve(Eigen::MatrixXd::Identity(slopes.cols(), slopes.cols()))};
}

/// A variance with its number of degrees of freedom; infinity: the variance counts as known.
struct Variance {
  double value = 0, freedom = std::numeric_limits<double>::infinity();
};

/// Variance of the estimates from the later readings, with a constant baseline model. Blocks of some seconds
/// show the noise, but not the differences between runs. The runs show both, with fewer degrees of freedom.
/// The larger one of the two variances is used. Two runs have only one degree of freedom, so fewer than three
/// runs are not used.
class LaterVariance {
 public:
  LaterVariance(const LaterReadings& readings, const Eigen::MatrixXd& slopes, const Eigen::VectorXd& white)
      : by_block_(covariance_of(readings, slopes, white)),
        runs_(static_cast<double>(readings.records().size())) {
    if (are_enough(readings.records().size())) by_run_ = covariance_between_runs(readings, slopes, white);
  }
  [[nodiscard]] static bool are_enough(std::size_t runs) { return runs >= 3; }
  [[nodiscard]] Variance by_block(const Eigen::VectorXd& step) const {
    return {.value = step.dot(by_block_ * step)};
  }
  [[nodiscard]] Variance of(const Eigen::VectorXd& step) const {
    const Variance block = by_block(step);
    if (by_run_.size() == 0) return block;
    const double run = step.dot(by_run_ * step);
    return run > block.value ? Variance{run, runs_ - 1} : block;
  }

 private:
  Eigen::MatrixXd by_block_, by_run_;
  double runs_;
};

/// Returns the variance of a later run, because of the differences between runs and the errors of the
/// structure of the baseline model: the mean square of the deviations, weighted with their accuracy. A unit
/// is predicted from the n - 1 other units, so its mean square is larger by n / (n - 1) than the variance
/// between runs. The variance is not divided by the number of later runs, because an error of the structure
/// is the same in all of them. The noise within the units is not subtracted, because the later runs are also
/// predicted from healthy runs with noise. The differences between n runs have n - 1 degrees of freedom. The
/// two halves of one run contain no difference between runs, and each half has its own error.
/// @param slopes  derivatives of the quantity with respect to the steps of the parameters.
Variance of_a_run(const std::vector<Deviation>& deviations, const Eigen::VectorXd& slopes, bool are_runs) {
  double squares = 0, weights = 0;
  for (const Deviation& each : deviations) {
    const double noise = slopes.dot(each.covariance * slopes);
    if (!(noise > 0) || !std::isfinite(noise)) continue;
    squares += square(slopes.dot(each.steps)) / noise;
    weights += 1 / noise;
  }
  const auto n = static_cast<double>(deviations.size());
  if (!(weights > 0) || n < 2) return {};
  return {squares / weights * (n - 1) / n, are_runs ? n - 1 : n};
}

/// Returns the parameters that result from the baseline models which were fitted without one unit, minus the
/// parameters that result from the fit to all units, in units of the steps. One linear step in the later
/// readings gives each difference.
/// @param left_out  later readings relative to each of these models.
std::vector<Eigen::VectorXd> moves_without_a_unit(std::span<const LaterReadings> left_out,
                                                  const std::vector<FittedEffect>& found,
                                                  const Eigen::MatrixXd& slopes,
                                                  const Eigen::VectorXd& white) {
  const Eigen::LDLT<Eigen::MatrixXd> solver = curvature_of(slopes);
  std::vector<Eigen::VectorXd> moves;
  for (const LaterReadings& each : left_out) {
    const Eigen::VectorXd other = each.white_and_gain(found);
    if (other.size() == white.size() && other.allFinite())
      moves.push_back(-solver.solve(slopes.transpose() * (other - white)));
  }
  return moves;
}

/// Returns the variance because of the uncertainty of the baseline model: the delete-one jackknife over the
/// healthy units (Efron and Tibshirani, An Introduction to the Bootstrap, 1993, chapter 11). The degrees of
/// freedom are those of of_a_run().
Variance of_the_baseline(const std::vector<Eigen::VectorXd>& moves, const Eigen::VectorXd& slopes,
                         bool are_runs) {
  const auto n = static_cast<double>(moves.size());
  if (n < 2) return {};
  double sum = 0, squares = 0;
  for (const Eigen::VectorXd& each : moves) {
    sum += slopes.dot(each);
    squares += square(slopes.dot(each));
  }
  return {std::max(0.0, squares - sum * sum / n) * (n - 1) / n, are_runs ? n - 1 : n};
}

/// Returns the part of the variance of a gain change that covariance_of() lacks. The later readings contain
/// the spread of the gain between runs as a penalty; the mean gain of the healthy runs has the same spread.
Variance of_healthy_gain(const Base& base) {
  const auto runs = static_cast<double>(base.records.size());
  return {square(base.gain_spread) / runs, runs - 1 + limits::usual_gain_runs};
}

/// Returns the interval of a value whose variance is the sum of several variances (Student's t). The number
/// of degrees of freedom follows from Welch (Biometrika 34, 1947).
std::optional<Interval> interval(double value, std::initializer_list<Variance> parts) {
  double variance = 0, uncertain = 0;
  for (const Variance& part : parts) {
    variance += part.value;
    uncertain += square(part.value) / part.freedom;
  }
  if (!std::isfinite(variance) || !(variance > 0)) return std::nullopt;
  static_assert(limits::probability == 0.95);
  const double quantile = uncertain > 0 ? t_quantile(square(variance) / uncertain) : limits::deviate;
  const double half = quantile * std::sqrt(variance);
  return Interval{value - half, value + half};
}

std::optional<Interval> within(const EffectNumber& number, std::optional<Interval> interval) {
  if (interval) {
    for (double* const end : {&interval->lower, &interval->upper})
      *end = std::clamp(*end, number.lower, number.upper);
  }
  return interval;
}

/// Returns the size of the effect with the current values of its parameters.
double size_with(const LaterReadings& readings, const FittedEffect& effect) {
  return size_of(readings, effect, at_full_pressure(readings, readings.added({effect}))).value;
}

/// Returns true for a position of the finger or a limit of the sensor.
bool is_position(const EffectNumber& number) {
  return number.name == "position_mm" || number.name == "upper_mm" || number.name == "lower_mm";
}

/// A position in the readings. The baseline model has its own zero, so a position in the readings is a
/// position in the model plus the zero offset of the readings. If the zero of the later readings differs from
/// the zero of the healthy readings, the difference can be an offset of the sensor or a displacement of the
/// finger. The interval therefore contains the position in the healthy readings too.
struct Zero {
  double later_mm = 0, healthy_mm = 0;
  [[nodiscard]] std::optional<Interval> of_readings(std::optional<Interval> in_model) const {
    if (!in_model) return in_model;
    return Interval{in_model->lower + std::min(later_mm, healthy_mm),
                    in_model->upper + std::max(later_mm, healthy_mm)};
  }
};

}  // namespace

std::vector<EffectIntervals> intervals_of(const LaterReadings& readings,
                                          const std::vector<FittedEffect>& found,
                                          const std::vector<HealthyFits>& healthy,
                                          std::span<const LaterReadings> left_out) {
  const std::vector<Place> places = places_of(found);
  const Eigen::VectorXd white = readings.white_and_gain(found);
  const Eigen::MatrixXd slopes = slopes_of(readings, found, places, white);
  const LaterVariance later(readings, slopes, white);
  std::vector<Deviation> deviations;
  for (const HealthyFits& unit : healthy) deviations.push_back(deviation_in(unit.readings, found, places));
  const std::vector<Eigen::VectorXd> moves = moves_without_a_unit(left_out, found, slopes, white);
  const bool are_runs = readings.base().units.are_runs();
  const auto interval_of = [&](double value, const Eigen::VectorXd& step) {
    return interval(value, {later.of(step), of_a_run(deviations, step, are_runs),
                            of_the_baseline(moves, step, are_runs)});
  };
  // `unit` converts a gain to the unit of the value.
  const auto interval_of_gain = [&](double value, const Eigen::VectorXd& step, double unit) {
    Variance healthy_gain = of_healthy_gain(readings.base());
    healthy_gain.value *= square(unit);
    return interval(value, {later.by_block(step), healthy_gain});
  };
  const Zero zero{readings.nuisance(found).zero_mm, readings.base().zero_mm};
  std::vector<EffectIntervals> all(found.size());
  for (std::size_t e = 0; e < found.size(); ++e) {
    const FittedEffect& effect = found[e];
    const bool is_gain = is_sized_by_both_gains(effect);
    const double size = size_with(readings, effect);
    Eigen::VectorXd size_slopes = Eigen::VectorXd::Zero(slopes.cols());
    all[e].values = effect.numbers;
    for (std::size_t c = 0; c < places.size(); ++c) {
      const Place& place = places[c];
      if (place.effect != e) continue;
      const auto i = static_cast<Eigen::Index>(c);
      const bool felt = slopes.col(i).squaredNorm() > 0;
      const EffectNumber& number = effect.effect.numbers[place.number];
      std::optional<Interval> own;
      if (felt) {
        const Eigen::VectorXd step = place.by * Eigen::VectorXd::Unit(slopes.cols(), i);
        const double value = effect.numbers[place.number];
        own = within(number, is_gain ? interval_of_gain(value, step, 1) : interval_of(value, step));
      }
      if (is_position(number)) {
        all[e].values[place.number] += zero.later_mm;
        own = zero.of_readings(own);
      }
      all[e].numbers.push_back(own);
      // A step of the gain of the effect changes the gain within the spread by the opposite amount. The sum
      // of both would seem to be known exactly.
      if (felt)
        size_slopes(i) = is_gain ? 100 * place.by : size_with(readings, moved(found, place)[e]) - size;
    }
    if (later.by_block(size_slopes).value > 0)
      all[e].size = is_gain ? interval_of_gain(size, size_slopes, 100) : interval_of(size, size_slopes);
  }
  return all;
}

std::vector<std::string> contained_in_intervals(const Base& base, std::size_t later_runs) {
  std::vector<std::string> sources{"noise of the later logs"};
  if (LaterVariance::are_enough(later_runs)) sources.emplace_back("differences between the later logs");
  sources.emplace_back("uncertainty of the baseline model");
  if (base.units.are_runs())
    sources.emplace_back("differences between the healthy logs");
  else
    sources.emplace_back("error between the two halves of the healthy log");
  return sources;
}

}  // namespace softgrip::sysid
