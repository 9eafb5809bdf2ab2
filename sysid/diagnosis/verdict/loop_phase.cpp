#include "sysid/diagnosis/verdict/loop_phase.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

#include <Eigen/QR>

#include "base/statistics.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

struct Series {
  std::vector<double> command, reading, response;
};

/// Returns the samples in which all series are finite. The response may be empty.
Series finite_samples(const std::vector<double>& command, const std::vector<double>& reading,
                      const std::vector<double>& response = {}) {
  Series series;
  for (std::size_t i = 0; i < std::min(command.size(), reading.size()); ++i) {
    if (!std::isfinite(command[i]) || !std::isfinite(reading[i])) continue;
    if (!response.empty() && !std::isfinite(response[i])) continue;
    series.command.push_back(command[i]);
    series.reading.push_back(reading[i]);
    if (!response.empty()) series.response.push_back(response[i]);
  }
  return series;
}

struct Pair {
  Eigen::VectorXd command, reading;
};

/// Returns the samples in which command and reading are finite. Both series are scaled to zero mean and unit
/// standard deviation. The result is empty if one of the series is constant.
Pair pairs_of(const std::vector<double>& command, const std::vector<double>& reading) {
  const auto [u, y, unused] = finite_samples(command, reading);
  const auto scaled = [](const std::vector<double>& values) {
    Eigen::VectorXd v =
        Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
    if (v.size() == 0) return v;
    v.array() -= v.mean();
    const double spread = std::sqrt(v.squaredNorm() / static_cast<double>(v.size()));
    return spread > 0 ? Eigen::VectorXd(v / spread) : Eigen::VectorXd();
  };
  Pair pair{scaled(u), scaled(y)};
  if (pair.command.size() == 0 || pair.reading.size() == 0) return {};
  return pair;
}

/// Returns the part of the target that a linear combination of the columns does not describe.
Eigen::VectorXd beyond(const Eigen::MatrixXd& columns, const Eigen::VectorXd& target) {
  return target - columns * columns.colPivHouseholderQr().solve(target);
}

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
  const auto [u, y] = pairs_of(command, reading);
  return u.dot(y) > 0;
}

}  // namespace

bool is_closed_loop(const std::vector<double>& command, const std::vector<double>& reading) {
  constexpr Eigen::Index order = 3, fewest = 50;
  const auto [u, y] = pairs_of(command, reading);
  const Eigen::Index rows = u.size() - order;
  if (rows < fewest ||
      third_difference_noise({u.data(), static_cast<std::size_t>(u.size())}) < limits::planned_roughness)
    return false;
  Eigen::MatrixXd columns(rows, 2 * order);
  for (Eigen::Index lag = 1; lag <= order; ++lag) {
    columns.col(lag - 1) = u.segment(order - lag, rows);
    columns.col(order + lag - 1) = y.segment(order - lag, rows);
  }
  const Eigen::VectorXd target = u.tail(rows), new_command = beyond(columns, target);
  const double own = beyond(columns.leftCols(order), target).squaredNorm(), both = new_command.squaredNorm();
  const auto free = static_cast<double>(rows - 2 * order);
  // If past values of the command predict the command exactly, only rounding errors remain. The F test of
  // rounding errors would have no meaning.
  if (!(own > 1e-12 * static_cast<double>(rows)) || !(both > 0)) return false;
  const double f = (own - both) / static_cast<double>(order) / (both / free);
  if (f > f_quantile(limits::strict_probability, static_cast<double>(order), free)) return true;
  const Eigen::VectorXd new_reading = beyond(columns, y.tail(rows));
  const double correlation = new_command.dot(new_reading) / (new_command.norm() * new_reading.norm());
  // Square of Student's t of a partial correlation.
  const double t2 = square(correlation) * (free - 1) / (1 - square(correlation));
  return correlation < 0 && t2 > square(limits::strict_deviate);
}

std::optional<double> phase_ratio(const std::vector<double>& command, const std::vector<double>& reading) {
  const auto [u, y] = pairs_of(command, reading);
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
