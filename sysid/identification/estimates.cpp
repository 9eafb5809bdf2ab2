#include "sysid/identification/estimates.h"
#include "base/numbers.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/numbers.h"
#include "base/parallel.h"
#include "sysid/fitting/minimise.h"
#include "sysid/identification/combinations.h"

namespace softgrip::sysid {
namespace {

/// A parameter is identifiable if half the width of its interval is at most this share of the larger of two
/// numbers: the magnitude of the parameter's value and its typical change. For a stiffness or damping, only
/// the value counts.
constexpr double narrow_share = 0.5;

Estimate estimate_of(const FittedPoint& fit, std::size_t index) {
  const FreeParameter& p = fit.residuals.space().free()[index];
  const Uncertainty& u = fit.uncertainty;
  Estimate e;
  e.name = p.name;
  e.unit = p.unit;
  e.free = true;
  e.value = std::clamp(p.to_value(fit.z[index]), p.lower, p.upper);
  if (u.without_effect[index]) {
    e.note = "the parameter has no effect on these logs";
    return e;
  }
  if (u.at_bound[index]) {
    e.note = "the value is at the bound of its range";
    return e;
  }
  const double half_z = u.quantile * u.deviation(index);
  const double lower = p.to_value(fit.z[index] - half_z);
  const double upper = p.to_value(fit.z[index] + half_z);
  e.ci95 = Interval{std::max(lower, p.lower), std::min(upper, p.upper)};
  const double half = (upper - lower) / 2;
  e.identifiable = half <= narrow_share * std::max(std::abs(e.value), p.logarithmic ? 0 : p.scale);
  return e;
}

/// Computes the profile likelihood of one parameter: moves the parameter away from its optimum and fits all
/// other parameters.
class Profile {
 public:
  Profile(const Residuals& residuals, const std::vector<double>& z, const Uncertainty& u, double huber_mm,
          std::size_t index)
      : residuals_(residuals), z_(z), index_(index), huber_mm_(huber_mm) {
    const double white = u.white_variance(static_cast<Eigen::Index>(index));
    const double deviation = u.deviation(index);
    // The covariance of the estimates does not contain a parameter at its bound. The factor for such a
    // parameter is that of the mean of the residuals.
    const double inflation = white > 0 ? deviation * deviation / white
                                       : static_cast<double>(residuals.count()) / u.noise.effective_samples;
    step_ = std::max(deviation > 0 ? deviation : u.lone_deviation(static_cast<Eigen::Index>(index)), 1e-6);
    // The cost is half the sum of squares, so the threshold is half of sigma^2 q^2. Here, sigma is the
    // standard deviation of the noise, and q is the quantile of Student's t distribution instead of the
    // normal quantile.
    allowed_ = 0.5 * u.noise.deviation_mm * u.noise.deviation_mm * u.quantile * u.quantile *
               std::max(1.0, inflation);
    at_minimum_ = cost_at(z, z[index]).cost;
  }

  /// Returns the coordinate of the parameter at which the cost exceeds its minimum by the threshold. If the
  /// cost does not reach the threshold within the bound of the parameter, returns the bound. Returns nullopt
  /// if the search reaches neither the threshold nor the bound.
  [[nodiscard]] std::optional<double> edge(double direction) const {
    const FreeParameter& p = residuals_.space().free()[index_];
    const double bound = direction < 0 ? p.lower_z() : p.upper_z();
    double inside = z_[index_];
    double outside = inside;
    std::vector<double> followed = z_;
    double stride = 1.5 * step_;
    for (int i = 0; i < most_strides; ++i) {
      outside = inside + direction * stride;
      const bool beyond = direction * (outside - bound) >= 0;
      if (beyond) outside = bound;
      const Minimum minimum = cost_at(followed, outside);
      if (minimum.cost - at_minimum_ > allowed_) return refined(std::move(followed), inside, outside);
      if (beyond) return bound;
      followed = minimum.z;
      inside = outside;
      stride *= 1.6;
    }
    return std::nullopt;
  }

 private:
  /// Largest number of steps from the minimum. The steps grow, so that together they span 10^8 first steps.
  static constexpr int most_strides = 40;

  /// Returns the coordinate at which the cost exceeds its minimum by the threshold. This coordinate lies
  /// between `inside` and `outside`.
  /// @param followed  minimum of the other parameters at `inside`.
  [[nodiscard]] double refined(std::vector<double> followed, double inside, double outside) const {
    for (int i = 0; i < 10; ++i) {
      const double middle = (inside + outside) / 2;
      const Minimum minimum = cost_at(followed, middle);
      if (minimum.cost - at_minimum_ > allowed_) {
        outside = middle;
      } else {
        inside = middle;
        followed = minimum.z;
      }
    }
    return (inside + outside) / 2;
  }

  /// Returns the smallest cost if the parameter has the value `held`. The search for the other parameters
  /// starts at `from`.
  [[nodiscard]] Minimum cost_at(const std::vector<double>& from, double held) const;

  const Residuals& residuals_;
  const std::vector<double>& z_;
  std::size_t index_;
  double huber_mm_;
  double step_ = 0;
  double allowed_ = 0;
  double at_minimum_ = 0;
};

Minimum Profile::cost_at(const std::vector<double>& from, double held) const {
  std::vector<double> z = from;
  z[index_] = held;
  MinimiseOptions options;
  options.huber_mm = huber_mm_;
  options.most_iterations = 25;
  options.tolerance = 1e-9;
  options.held = index_;
  return minimise(residuals_, std::move(z), options);
}

}  // namespace

std::vector<Estimate> parameter_estimates(const FittedPoint& fit) {
  const FitSpace& space = fit.residuals.space();
  const model::Model model = space.point(fit.z).model;
  const std::vector<double> values = model::flat_values(model);
  std::vector<Estimate> estimates;
  for (std::size_t flat = 0; flat < values.size(); ++flat) {
    const auto found = std::find_if(space.free().begin(), space.free().end(), [flat](const FreeParameter& p) {
      return p.kind == FreeParameter::Kind::model && p.flat_index == flat;
    });
    Estimate& estimate = estimates.emplace_back();
    if (found != space.free().end()) {
      estimate = estimate_of(fit, static_cast<std::size_t>(found - space.free().begin()));
    } else {
      estimate.name = model::parameter_path(model, flat);
      estimate.unit = model::in_unit(model::parameter_spec(model, flat).unit, model.output_unit);
      estimate.value = values[flat];
      estimate.note = "the value was fixed at its start value";
    }
    estimate.formerly = model::former_path(model, flat);
  }
  return estimates;
}

void name_the_sum(std::vector<Estimate>& parameters) {
  for (Estimate& e : parameters) {
    const bool alpha = e.name == "bouc_wen.alpha_mm_per_kpa";
    if (!alpha && e.name != "kelvin_voigt.k0_kpa_per_mm") continue;
    e.ci95.reset();
    e.profile95.reset();
    e.identifiable = false;
    e.note =
        alpha ? "only the sum alpha + 1/k0 is identifiable; this value of alpha is valid for the fixed k0"
              : "the value was fixed at its start value, because only the sum alpha + 1/k0 is identifiable";
  }
}

std::vector<Estimate> start_estimates(const FittedPoint& fit) {
  std::vector<Estimate> estimates;
  const auto& free = fit.residuals.space().free();
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (free[i].kind != FreeParameter::Kind::model) estimates.push_back(estimate_of(fit, i));
  }
  return estimates;
}

std::vector<Estimate> combination_estimates(const FittedPoint& fit) {
  const FitSpace& space = fit.residuals.space();
  const Uncertainty& u = fit.uncertainty;
  const auto n = static_cast<Eigen::Index>(fit.z.size());
  std::vector<Estimate> estimates;
  const model::Model model = space.point(fit.z).model;
  for (const Combination& combination : combinations_of(model)) {
    const auto value_at = [&](const std::vector<double>& z) {
      return combination.value(space.point(z).model);
    };
    Estimate e;
    e.name = combination.name;
    e.formerly = combination.formerly.name;
    e.unit = model::in_unit(combination.unit, model.output_unit);
    e.formula = combination.formula;
    e.value = value_at(fit.z);
    const bool positive = e.value > 0 && combination.scale == 0;
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n);
    bool moves = false;
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (u.at_bound[at] || u.without_effect[at]) continue;
      std::vector<double> z = fit.z;
      const double step = 1e-4 * std::max(1.0, std::abs(z[at]));
      z[at] = fit.z[at] + step;
      const double above = value_at(z);
      z[at] = fit.z[at] - step;
      const double below = value_at(z);
      gradient(i) = (positive ? std::log(above / below) : above - below) / (2 * step);
      moves = moves || gradient(i) != 0;
    }
    e.free = moves;
    if (moves && std::isfinite(gradient.sum())) {
      const double half = u.quantile * (u.root.transpose() * gradient).norm();
      const Interval interval = positive ? Interval{e.value * std::exp(-half), e.value * std::exp(half)}
                                         : Interval{e.value - half, e.value + half};
      if (std::isfinite(interval.upper)) {
        e.ci95 = interval;
        e.identifiable = (interval.upper - interval.lower) / 2 <=
                         narrow_share * std::max(std::abs(e.value), combination.scale);
      } else {
        e.note = "these logs do not determine this quantity";
      }
    } else {
      e.note = "this quantity depends only on parameters that are fixed or at a bound of their range";
    }
    estimates.push_back(std::move(e));
  }
  return estimates;
}

void add_profiles(const Residuals& residuals, const std::vector<double>& z, const Uncertainty& uncertainty,
                  double huber_mm, unsigned threads, std::vector<Estimate>& estimates) {
  const auto& free = residuals.space().free();
  std::vector<std::optional<double>> edges(2 * free.size());
  parallel_for(2 * free.size(), threads, [&](std::size_t job) {
    const std::size_t index = job / 2;
    if (free[index].kind != FreeParameter::Kind::model || uncertainty.without_effect[index]) return;
    const Profile profile(residuals, z, uncertainty, huber_mm, index);
    if (const auto edge = profile.edge(job % 2 == 0 ? -1 : 1))
      edges[job] = std::clamp(free[index].to_value(*edge), free[index].lower, free[index].upper);
  });
  for (std::size_t index = 0; index < free.size(); ++index) {
    const auto &lower = edges[2 * index], &upper = edges[2 * index + 1];
    if (!lower || !upper) continue;
    const auto found = std::find_if(estimates.begin(), estimates.end(),
                                    [&](const Estimate& e) { return e.name == free[index].name; });
    if (found != estimates.end()) found->profile95 = Interval{*lower, *upper};
  }
}

}  // namespace softgrip::sysid
