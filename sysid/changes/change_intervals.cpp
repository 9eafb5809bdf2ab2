#include "sysid/changes/change_intervals.h"

#include <algorithm>
#include <cmath>
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

/// Returns the covariance of the parameters in units of their steps. A parameter that has no effect on the
/// readings has zero derivatives and does not contribute.
Eigen::MatrixXd covariance_of(const LaterReadings& readings, const Eigen::MatrixXd& slopes,
                              const Eigen::VectorXd& white) {
  Eigen::MatrixXd curvature = slopes.transpose() * slopes;
  curvature.diagonal().array() += 1e-12 * (1 + curvature.trace());
  const Eigen::LDLT<Eigen::MatrixXd> solver(curvature);
  return solver.solve(solver.solve(spread_of_gradient(readings, slopes, white)).transpose());
}

std::optional<Interval> interval(double value, double variance) {
  if (!std::isfinite(variance) || !(variance > 0)) return std::nullopt;
  const double half = limits::deviate * std::sqrt(variance);
  return Interval{value - half, value + half};
}

std::optional<Interval> within(const EffectNumber& number, std::optional<Interval> interval) {
  if (interval) {
    for (double* const end : {&interval->lower, &interval->upper})
      *end = std::clamp(*end, number.lower, number.upper);
  }
  return interval;
}

/// Returns the fit of this form of the effect in a healthy cross-validation unit. Returns nullptr if the form
/// does not reduce the error of the unit.
const FittedEffect* same_form(const HealthyFits& unit, const FittedEffect& effect) {
  for (const ScoredEffect& each : unit.ranked) {
    const FittedEffect& fitted = each.fit.fitted;
    if (fitted.effect.id == effect.effect.id && fitted.effect.form == effect.effect.form && each.gain > 0)
      return &fitted;
  }
  return nullptr;
}

/// Returns the variance between runs of a quantity that depends on the fitted form. It is the mean square
/// over the n healthy units, multiplied by 1 + 1/n. The factor is necessary because a further run is compared
/// with the mean of the healthy units.
/// @param value_of  function that computes the quantity.
template <class ValueOf>
double between_runs(const std::vector<HealthyFits>& healthy, const FittedEffect& effect, ValueOf value_of) {
  const auto units = static_cast<double>(healthy.size());
  double sum = 0;
  for (const HealthyFits& unit : healthy) {
    if (const FittedEffect* const fitted = same_form(unit, effect)) sum += square(value_of(unit, *fitted));
  }
  return healthy.empty() ? 0 : sum / units * (1 + 1 / units);
}

double healthy_variance(const std::vector<HealthyFits>& healthy, const FittedEffect& effect,
                        std::size_t number) {
  const double nothing = effect.effect.nothing[number];
  if (!std::isfinite(nothing)) return 0;
  return between_runs(healthy, effect, [&](const HealthyFits&, const FittedEffect& fitted) {
    return fitted.numbers[number] - nothing;
  });
}

/// Returns the size of the effect with the current values of its parameters.
double size_with(const LaterReadings& readings, const FittedEffect& effect) {
  return size_of(readings, effect, at_full_pressure(readings, readings.added({effect}))).value;
}

double healthy_size_variance(const std::vector<HealthyFits>& healthy, const FittedEffect& effect) {
  return between_runs(healthy, effect, [](const HealthyFits& unit, const FittedEffect& fitted) {
    return size_with(unit.readings, fitted);
  });
}

}  // namespace

std::vector<EffectIntervals> intervals_of(const LaterReadings& readings,
                                          const std::vector<FittedEffect>& found,
                                          const std::vector<HealthyFits>& healthy) {
  const std::vector<Place> places = places_of(found);
  const Eigen::VectorXd white = readings.white_and_gain(found);
  const Eigen::MatrixXd slopes = slopes_of(readings, found, places, white);
  const Eigen::MatrixXd covariance = covariance_of(readings, slopes, white);
  std::vector<EffectIntervals> all(found.size());
  for (std::size_t e = 0; e < found.size(); ++e) {
    const FittedEffect& effect = found[e];
    const double size = size_with(readings, effect);
    Eigen::VectorXd size_slopes = Eigen::VectorXd::Zero(covariance.rows());
    for (std::size_t c = 0; c < places.size(); ++c) {
      const Place& place = places[c];
      if (place.effect != e) continue;
      const auto i = static_cast<Eigen::Index>(c);
      const bool felt = slopes.col(i).squaredNorm() > 0;
      const double variance =
          felt ? covariance(i, i) * square(place.by) + healthy_variance(healthy, effect, place.number) : 0;
      all[e].numbers.push_back(
          within(effect.effect.numbers[place.number], interval(effect.numbers[place.number], variance)));
      // A step of the gain of the effect changes the gain within the spread by the opposite amount. The sum
      // of both would seem to be known exactly.
      if (felt)
        size_slopes(i) = is_sized_by_both_gains(effect) ? 100 * place.by
                                                        : size_with(readings, moved(found, place)[e]) - size;
    }
    const double size_variance = size_slopes.dot(covariance * size_slopes);
    if (size_variance > 0)
      all[e].size = interval(size, size_variance + healthy_size_variance(healthy, effect));
  }
  return all;
}

}  // namespace softgrip::sysid
