#include "strength.h"

#include <algorithm>
#include <cmath>

namespace blind {
namespace {

constexpr double coarse_step_s = 0.0025;  // sufficient to scale an effect; the logs are simulated with a
                                          // smaller time step

std::vector<double> flat(const Base& base, const Effects& effects, const std::vector<LogInput>& logs,
                         std::uint64_t seed) {
  std::vector<double> all;
  for (const LogOutput& out : simulate(base, effects, logs, seed, coarse_step_s))
    all.insert(all.end(), out.displacement_mm.begin(), out.displacement_mm.end());
  return all;
}

std::vector<std::vector<double>> base_directions(const Base& base, const std::vector<LogInput>& logs,
                                                 std::uint64_t seed) {
  const std::vector<double Base::*> members{&Base::alpha,     &Base::beta,      &Base::gamma,
                                            &Base::eta,       &Base::fast_gain, &Base::fast_tau,
                                            &Base::slow_gain, &Base::slow_tau};
  std::vector<std::vector<double>> directions;
  for (const auto member : members) {
    Base up = base, down = base;
    up.*member *= 1.01;
    down.*member *= 0.99;
    std::vector<double> direction = flat(up, {}, logs, seed);
    const std::vector<double> other = flat(down, {}, logs, seed);
    for (std::size_t k = 0; k < direction.size(); ++k) direction[k] -= other[k];
    directions.push_back(std::move(direction));
  }
  directions.emplace_back(directions.front().size(), 1.0);
  return directions;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

void subtract(std::vector<double>& from, const std::vector<double>& direction, double factor) {
  for (std::size_t k = 0; k < from.size(); ++k) from[k] -= factor * direction[k];
}

// Runs the Gram-Schmidt orthonormalisation twice. After a single run, rounding errors leave the vectors
// slightly non-orthogonal.
void orthonormalise(std::vector<std::vector<double>>& directions) {
  for (std::size_t i = 0; i < directions.size(); ++i) {
    for (int pass = 0; pass < 2; ++pass)
      for (std::size_t j = 0; j < i; ++j)
        subtract(directions[i], directions[j], dot(directions[i], directions[j]));
    const double length = std::sqrt(dot(directions[i], directions[i]));
    for (double& value : directions[i]) value /= length;
  }
}

class Meter {
 public:
  Meter(const Base& base, const std::vector<LogInput>& logs, std::uint64_t seed)
      : base_(base),
        logs_(logs),
        seed_(seed),
        plain_(flat(base, {}, logs, seed)),
        directions_(base_directions(base, logs, seed)) {
    orthonormalise(directions_);
  }
  double excess_mm(const Effects& effects) const {
    std::vector<double> difference = flat(base_, effects, logs_, seed_);
    subtract(difference, plain_, 1);
    for (const auto& direction : directions_) subtract(difference, direction, dot(difference, direction));
    return std::sqrt(dot(difference, difference) / static_cast<double>(difference.size()));
  }
  double span_mm() const { return *std::max_element(plain_.begin(), plain_.end()); }

 private:
  const Base& base_;
  const std::vector<LogInput>& logs_;
  std::uint64_t seed_;
  std::vector<double> plain_;
  std::vector<std::vector<double>> directions_;
};

}  // namespace

double excess_mm(const Base& base, const Effects& effects, const std::vector<LogInput>& logs,
                 std::uint64_t seed) {
  return Meter(base, logs, seed).excess_mm(effects);
}

Scaled scale_to(const std::string& id, double target_mm, const Base& base, const std::vector<LogInput>& logs,
                std::uint64_t seed) {
  const Meter meter(base, logs, seed);
  const auto effect = [&](double s) {
    return draw_effect(id, s, seed, meter.span_mm(), worlds::duration_s(logs));
  };
  double low = std::log(1e-5), high = 0;
  const double largest = meter.excess_mm({{id, effect(1)}});
  if (largest < target_mm) return {effect(1), largest, false};
  double reached = largest;
  for (int i = 0; i < 16 && std::abs(reached / target_mm - 1) > 0.03; ++i) {
    const double middle = 0.5 * (low + high);
    reached = meter.excess_mm({{id, effect(std::exp(middle))}});
    (reached < target_mm ? low : high) = middle;
    if (std::abs(reached / target_mm - 1) <= 0.03) return {effect(std::exp(middle)), reached, true};
  }
  const double s = std::exp(high);
  return {effect(s), meter.excess_mm({{id, effect(s)}}), true};
}

}  // namespace blind
