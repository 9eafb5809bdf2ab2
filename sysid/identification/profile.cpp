#include "sysid/identification/profile.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "sysid/fitting/minimise.h"

namespace softgrip::sysid {
namespace {

/// Computes the profile likelihood of one parameter: moves the parameter away from its optimum and fits all
/// other parameters.
class Profile {
 public:
  Profile(const Residuals& residuals, const std::vector<double>& z, const Uncertainty& u, double huber_mm,
          std::size_t index)
      : residuals_(residuals), z_(z), index_(index), huber_mm_(huber_mm) {
    const auto i = static_cast<Eigen::Index>(index);
    const double white = u.naive(i, i);
    const double inflation = white > 0 ? std::max(1.0, u.covariance(i, i) / white) : 1;
    step_ = std::sqrt(std::max(u.covariance(i, i), 1e-12));
    // The cost is half the sum of squares, so the threshold is half of sigma^2 q^2. Here, sigma is the
    // standard deviation of the noise, and q is the quantile of Student's t distribution instead of the
    // normal quantile.
    allowed_ = 0.5 * u.noise.deviation_mm * u.noise.deviation_mm * u.quantile * u.quantile * inflation;
    at_minimum_ = cost_at(z, z[index]).cost;
  }

  /// Returns the value of the parameter at which the cost exceeds its minimum by the threshold. If the cost
  /// does not reach the threshold within the bound of the parameter, returns the bound.
  [[nodiscard]] double edge(double direction) const {
    const FreeParameter& p = residuals_.space().free()[index_];
    const double bound = direction < 0 ? p.lower_z() : p.upper_z();
    double inside = z_[index_];
    double outside = inside;
    std::vector<double> followed = z_;
    double stride = 1.5 * step_;
    for (int i = 0; i < 8; ++i) {
      outside = inside + direction * stride;
      const bool beyond = direction * (outside - bound) >= 0;
      if (beyond) outside = bound;
      const Minimum minimum = cost_at(followed, outside);
      if (minimum.cost - at_minimum_ > allowed_) break;
      if (beyond) return bound;
      followed = minimum.z;
      inside = outside;
      stride *= 1.6;
    }
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

 private:
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

void add_profiles(const Residuals& residuals, const std::vector<double>& z, const Uncertainty& uncertainty,
                  double huber_mm, unsigned threads, std::vector<Estimate>& estimates) {
  const auto& free = residuals.space().free();
  std::vector<Interval> intervals(free.size());
  parallel_for(2 * free.size(), threads, [&](std::size_t job) {
    const std::size_t index = job / 2;
    if (free[index].kind != FreeParameter::Kind::model || uncertainty.without_effect[index]) return;
    const Profile profile(residuals, z, uncertainty, huber_mm, index);
    const double edge = std::clamp(free[index].to_value(profile.edge(job % 2 == 0 ? -1 : 1)),
                                   free[index].lower, free[index].upper);
    (job % 2 == 0 ? intervals[index].lower : intervals[index].upper) = edge;
  });
  for (std::size_t index = 0; index < free.size(); ++index) {
    if (free[index].kind != FreeParameter::Kind::model || uncertainty.without_effect[index]) continue;
    const auto found = std::find_if(estimates.begin(), estimates.end(),
                                    [&](const Estimate& e) { return e.name == free[index].name; });
    if (found != estimates.end()) found->profile95 = intervals[index];
  }
}

}  // namespace softgrip::sysid
