#include "sysid/diagnosis/residual/closed_loop.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/QR>

#include "base/statistics.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// Returns the values with zero mean and unit standard deviation. The result is empty if they are constant.
Eigen::VectorXd scaled(const std::vector<double>& values) {
  Eigen::VectorXd v =
      Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  if (v.size() == 0) return v;
  v.array() -= v.mean();
  const double spread = std::sqrt(v.squaredNorm() / static_cast<double>(v.size()));
  return spread > 0 ? Eigen::VectorXd(v / spread) : Eigen::VectorXd();
}

/// Returns the part of the target that a linear combination of the columns does not describe.
Eigen::VectorXd beyond(const Eigen::MatrixXd& columns, const Eigen::VectorXd& target) {
  return target - columns * columns.colPivHouseholderQr().solve(target);
}

}  // namespace

LoopSeries finite_samples(const std::vector<double>& command, const std::vector<double>& reading,
                          const std::vector<double>& response) {
  LoopSeries series;
  for (std::size_t i = 0; i < std::min(command.size(), reading.size()); ++i) {
    if (!std::isfinite(command[i]) || !std::isfinite(reading[i])) continue;
    if (!response.empty() && !std::isfinite(response[i])) continue;
    series.command.push_back(command[i]);
    series.reading.push_back(reading[i]);
    if (!response.empty()) series.response.push_back(response[i]);
  }
  return series;
}

ScaledPair scaled_pair(const std::vector<double>& command, const std::vector<double>& reading) {
  const LoopSeries series = finite_samples(command, reading);
  ScaledPair pair{scaled(series.command), scaled(series.reading)};
  if (pair.command.size() == 0 || pair.reading.size() == 0) return {};
  return pair;
}

bool is_closed_loop(const std::vector<double>& command, const std::vector<double>& reading) {
  constexpr Eigen::Index order = 3, fewest = 50;
  const auto [u, y] = scaled_pair(command, reading);
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

}  // namespace softgrip::sysid
