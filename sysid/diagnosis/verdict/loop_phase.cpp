#include "sysid/diagnosis/verdict/loop_phase.h"

#include <cmath>
#include <cstddef>
#include <utility>

#include <Eigen/Core>

#include "sysid/diagnosis/residual/closed_loop.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// Returns the smallest positive lag at which the correlation sum a(t) b(t + lag) changes its sign,
/// interpolated between samples.
std::optional<double> first_crossing(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  double before = a.dot(b);
  for (Eigen::Index lag = 1; lag < a.size(); ++lag) {
    const double now = a.head(a.size() - lag).dot(b.tail(b.size() - lag));
    if (before * now <= 0) {
      const double step = before - now;
      return static_cast<double>(lag - 1) + (step != 0 ? before / step : 0);
    }
    before = now;
  }
  return std::nullopt;
}

/// Returns true if the correlation of command and reading at lag 0 is positive.
bool rise_together(const std::vector<double>& command, const std::vector<double>& reading) {
  const auto [u, y] = scaled_pair(command, reading);
  return u.dot(y) > 0;
}

}  // namespace

std::optional<double> phase_ratio(const std::vector<double>& command, const std::vector<double>& reading) {
  const auto [u, y] = scaled_pair(command, reading);
  if (u.size() == 0) return std::nullopt;
  const std::optional<double> right = first_crossing(u, y), left = first_crossing(y, u);
  if (!right || !left || *right + *left == 0) return std::nullopt;
  return std::abs(*left - *right) / (*left + *right);
}

std::optional<StickingStem> shown_stiction(const std::vector<double>& command,
                                           const std::vector<double>& reading,
                                           const std::vector<double>& response) {
  if (!is_closed_loop(command, reading)) return std::nullopt;
  auto [u, y, modelled] = finite_samples(command, reading, response);
  OtherExplanations others;
  if (rise_together(u, y)) {
    const std::optional<double> ratio = phase_ratio(u, y);
    others.curved = ratio && *ratio <= limits::even_phase_ratio;
    others.response = std::move(modelled);
  }
  const std::optional<StickingStem> stem = best_sticking_stem(u, y, others);
  if (!stem || stem->log_likelihood_ratio <= limits::strict_log_likelihood) return std::nullopt;
  return stem;
}

}  // namespace softgrip::sysid
