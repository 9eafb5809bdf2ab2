#include "sysid/changes/effect_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "sysid/fitting/descent.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// Penalty for each parameter of an effect, in the unit of the sum of the squared whitened residuals. An
/// unnecessary parameter reduces this sum by more than the penalty with a probability of 0.5 % (chi-square
/// with one degree of freedom).
constexpr double price_of_a_number = 8;

constexpr int most_effect_steps = 9;
/// Smallest damping of a parameter, as a share of the sum of the curvatures of all parameters.
constexpr double least_curvature = 0.01;
/// Largest number of start points of an effect to which sized() is applied. If an effect has more start
/// points, they are close together, so sized() is not necessary.
constexpr std::size_t most_sized = 16;

std::vector<double> within(const Effect& effect, std::vector<double> numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i)
    numbers[i] = std::clamp(numbers[i], effect.numbers[i].lower, effect.numbers[i].upper);
  return numbers;
}

/// Returns the scale of this parameter in the fit: one unit of the search coordinate, in units of the
/// parameter.
double unit(const FittedEffect& fitted, std::size_t i) {
  const double scale = std::min(fitted.effect.numbers[i].scale, fitted.effect.numbers[i].upper);
  return std::max(0.3 * std::abs(fitted.numbers[i]), 0.05 * scale);
}

class Fit {
 public:
  Fit(const LaterReadings& readings, const Effect& effect, const std::vector<FittedEffect>& others)
      : readings_(readings), effect_(effect), others_(others) {}

  [[nodiscard]] EffectFit at(const std::vector<double>& numbers) const {
    std::vector<FittedEffect> all = others_;
    all.push_back({effect_, numbers});
    EffectFit fit{{effect_, numbers}, 0, readings_.white(all)};
    fit.sum_of_squares = fit.white.squaredNorm();
    if (!std::isfinite(fit.sum_of_squares)) fit.sum_of_squares = std::numeric_limits<double>::infinity();
    return fit;
  }

  /// Fits the size of the effect by scaling the start point. Returns the better one of two fits, with and
  /// without the scaling.
  [[nodiscard]] EffectFit sized(EffectFit fit, const Eigen::VectorXd& without) const {
    if (!std::isfinite(fit.sum_of_squares)) return fit;
    const Eigen::VectorXd change = fit.white - without;
    const double square = change.squaredNorm();
    const double share = square > 0 ? -change.dot(without) / square : 0;
    if (share <= 0.02 || share >= 0.98) return fit;
    std::vector<double> smaller = fit.fitted.numbers;
    for (std::size_t i = 0; i < smaller.size(); ++i) {
      const double nothing = limit_of_nothing(i);
      if (std::isfinite(nothing)) smaller[i] = nothing + share * (smaller[i] - nothing);
    }
    EffectFit other = at(within(effect_, smaller));
    return other.sum_of_squares < fit.sum_of_squares ? other : fit;
  }

  [[nodiscard]] EffectFit descended(EffectFit from) const {
    return descend(*this, std::move(from),
                   {.most_steps = most_effect_steps,
                    .most_trials = 5,
                    .longest_step = std::numeric_limits<double>::infinity(),
                    .least_share = 1e-4,
                    .least_gain = 0.1,
                    // The fitted common gain can replace the gain of an effect. The sum of squares then does
                    // not depend on the gain of the effect, so the fit needs a damping.
                    .least_damping = least_curvature})
        .point;
  }

  [[nodiscard]] static double loss(const EffectFit& fit) { return fit.sum_of_squares; }

  [[nodiscard]] NormalEquations normal(const EffectFit& from) const {
    const auto n = static_cast<Eigen::Index>(effect_.numbers.size());
    Eigen::MatrixXd jacobian(from.white.size(), n);
    for (Eigen::Index k = 0; k < n; ++k) jacobian.col(k) = derivative(from, static_cast<std::size_t>(k));
    return {jacobian.transpose() * from.white, jacobian.transpose() * jacobian};
  }

  [[nodiscard]] StepBounds bounds(const EffectFit& from) const {
    const auto n = static_cast<Eigen::Index>(effect_.numbers.size());
    StepBounds bounds{Eigen::VectorXd(n), Eigen::VectorXd(n)};
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto i = static_cast<std::size_t>(k);
      bounds.lower(k) = (effect_.numbers[i].lower - from.fitted.numbers[i]) / unit(from.fitted, i);
      bounds.upper(k) = (effect_.numbers[i].upper - from.fitted.numbers[i]) / unit(from.fitted, i);
    }
    return bounds;
  }

  [[nodiscard]] EffectFit moved(const EffectFit& from, const Eigen::VectorXd& step) const {
    std::vector<double> numbers = from.fitted.numbers;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      numbers[i] += step(static_cast<Eigen::Index>(i)) * unit(from.fitted, i);
    return at(within(effect_, numbers));
  }

 private:
  /// Returns the value of the parameter for which the effect vanishes. For a limit, this value may be far
  /// outside the range of the data. In this case, returns the end of the range, where the effect begins.
  [[nodiscard]] double limit_of_nothing(std::size_t i) const {
    const double nothing = effect_.nothing[i];
    double reach = std::numeric_limits<double>::infinity();
    if (effect_.numbers[i].unit == "kPa") reach = campaign_size(readings_.records()).largest_kpa;
    if (effect_.numbers[i].unit == "mm") reach = campaign_size(readings_.records()).span_mm;
    return std::abs(nothing) > 1.5 * reach ? reach : nothing;
  }
  [[nodiscard]] Eigen::VectorXd derivative(const EffectFit& from, std::size_t k) const {
    std::vector<double> beside = from.fitted.numbers;
    const double by = small_move(from.fitted, k);
    beside[k] += by;
    return (at(beside).white - from.white) * (unit(from.fitted, k) / by);
  }

  const LaterReadings& readings_;
  const Effect& effect_;
  const std::vector<FittedEffect>& others_;
};

}  // namespace

double price_of(const Effect& effect) {
  return price_of_a_number * static_cast<double>(effect.numbers.size());
}

double small_move(const FittedEffect& fitted, std::size_t number) {
  const double by = 0.02 * unit(fitted, number);
  return fitted.numbers[number] + by > fitted.effect.numbers[number].upper ? -by : by;
}

EffectFit fit_effect(const LaterReadings& readings, const Effect& effect,
                     const std::vector<FittedEffect>& others, const Eigen::VectorXd& without) {
  const Fit fit(readings, effect, others);
  const bool dense = effect.starts.size() > most_sized;
  std::vector<EffectFit> looks;
  std::optional<EffectFit> none;
  for (const std::vector<double>& start : effect.starts) {
    EffectFit first = fit.at(within(effect, start));
    // An effect has no influence below some size, for example a dead time below the sampling interval. If a
    // start point has no influence, the fit cannot continue from it.
    if (!effect.free_form && first.white == without) {
      none = std::move(first);
      continue;
    }
    looks.push_back(dense ? std::move(first) : fit.sized(std::move(first), without));
  }
  if (looks.empty()) return *std::move(none);
  std::sort(looks.begin(), looks.end(),
            [](const EffectFit& a, const EffectFit& b) { return a.sum_of_squares < b.sum_of_squares; });
  EffectFit best = fit.descended(looks.front());
  for (std::size_t i = 1; i < std::min(limits::followed_starts, looks.size()); ++i) {
    EffectFit other = fit.descended(looks[i]);
    if (other.sum_of_squares < best.sum_of_squares) best = std::move(other);
  }
  // A limit that lies slightly below a few noisy readings reduces the error only by chance.
  if (none && best.sum_of_squares > none->sum_of_squares - price_of(effect)) return *std::move(none);
  return best;
}

}  // namespace softgrip::sysid
