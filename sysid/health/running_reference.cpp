#include "sysid/health/running_reference.h"

#include <algorithm>
#include <cmath>

#include "sysid/limits/limits.h"

namespace softgrip::sysid::health {
namespace {

/// The estimate of the persistence is reduced by this multiple of its standard error.
constexpr double surely = 0.5;
constexpr double most_persistence = 0.95;
/// A temperature slope is estimated only from at least this number of values, and if their temperatures have
/// at least this standard deviation.
constexpr double least_for_slope = 6;
constexpr double least_temperature_spread_c = 0.3;
/// Standard deviation of the extrapolated part of the regression line, as a share of this part. The line is
/// extrapolated beyond the temperatures of the earlier values.
constexpr double extrapolation_uncertainty = 0.5;

double persistence_of(const SerialSums& sums, double slope) {
  if (sums.count() < static_cast<double>(limits::fewest_for_correlation)) return 0;
  return std::clamp(sums.correlation(slope) - surely / std::sqrt(sums.count()), 0.0, most_persistence);
}

}  // namespace

double normal_of_t(double t, double degrees_of_freedom) {
  const double n = degrees_of_freedom;
  const double z = (8 * n + 1) / (8 * n + 3) * std::sqrt(n * std::log1p(t * t / n));
  return std::copysign(z, t);
}

void SerialSums::add(double x, double y) {
  if (n_ == 0) {
    x0_ = x;
    y0_ = y;
  }
  x -= x0_;
  y -= y0_;
  before_xx_ += x * last_x_;
  before_xy_ += x * last_y_;
  before_yx_ += y * last_x_;
  before_yy_ += y * last_y_;
  last_x_ = x;
  last_y_ = y;
  n_ += 1;
  x_ += x;
  y_ += y;
  xx_ += x * x;
  xy_ += x * y;
  yy_ += y * y;
}

double SerialSums::squares_x() const {
  return n_ > 0 ? std::max(0.0, xx_ - x_ * x_ / n_) : 0;
}

double SerialSums::squares_y() const {
  return n_ > 0 ? std::max(0.0, yy_ - y_ * y_ / n_) : 0;
}

double SerialSums::slope() const {
  const double squares = squares_x();
  return squares > 0 ? (xy_ - x_ * y_ / n_) / squares : 0;
}

double SerialSums::left(double slope) const {
  if (n_ == 0) return 0;
  return std::max(0.0, squares_y() - 2 * slope * (xy_ - x_ * y_ / n_) + slope * slope * squares_x());
}

double SerialSums::correlation(double slope) const {
  const double squares = left(slope);
  if (!(squares > 0)) return 0;
  // Returns the sum of the products of neighbouring values, after the mean is subtracted from all values. The
  // formula requires that the first value is 0; add() ensures this.
  const auto together = [&](double products, double now, double before, double last_before) {
    return products - now * (before - last_before) / n_ - before * now / n_ +
           (n_ - 1) * now * before / n_ / n_;
  };
  const double sum = together(before_yy_, y_, y_, last_y_) -
                     slope * (together(before_xy_, x_, y_, last_y_) + together(before_yx_, y_, x_, last_x_)) +
                     slope * slope * together(before_xx_, x_, x_, last_x_);
  return sum / squares + 1 / n_;
}

void RunningReference::learn(double value, double temperature_c) {
  all_.add(0, value);
  if (!std::isfinite(temperature_c)) return;
  warm_.add(temperature_c, value);
  lowest_c_ = std::min(lowest_c_, temperature_c);
  highest_c_ = std::max(highest_c_, temperature_c);
  slope_ = found_slope();
}

std::optional<TemperatureSlope> RunningReference::found_slope() const {
  const double n = warm_.count();
  const double squares = warm_.squares_x();
  if (n < least_for_slope || squares < (n - 1) * least_temperature_spread_c * least_temperature_spread_c)
    return std::nullopt;
  const double per_c = warm_.slope();
  const double persistence = persistence_of(warm_, per_c);
  const double error =
      std::sqrt(warm_.left(per_c) / (n - 2) / squares * (1 + persistence) / (1 - persistence));
  if (per_c == 0 || std::abs(normal_of_t(per_c / error, n - 2)) < limits::strict_deviate) return std::nullopt;
  return TemperatureSlope{per_c, error, lowest_c_, highest_c_, warm_.mean_x(), warm_.mean_y()};
}

double RunningReference::spread() const {
  const double n = all_.count();
  if (n < 2) return 0;
  if (slope_) return std::sqrt(warm_.left(slope_->per_c) / (warm_.count() - 2));
  return std::sqrt(all_.squares_y() / (n - 1));
}

double RunningReference::persistence() const {
  return slope_ ? persistence_of(warm_, slope_->per_c) : persistence_of(all_, 0);
}

double RunningReference::expected(double temperature_c) const {
  if (!slope_ || !std::isfinite(temperature_c)) return mean();
  return slope_->at(temperature_c);
}

std::optional<double> RunningReference::judge(double value, double least_spread, double temperature_c) const {
  const double off = value - expected(temperature_c);
  if (slope_ && std::isfinite(temperature_c)) {
    const double n = warm_.count();
    const double from_mean_c = temperature_c - warm_.mean_x();
    const double beyond_c = std::max({0.0, temperature_c - highest_c_, lowest_c_ - temperature_c});
    const double known = 1 + 1 / n + from_mean_c * from_mean_c / warm_.squares_x();
    const double spread = std::max(this->spread(), least_spread);
    return normal_of_t(
        off / std::hypot(spread * std::sqrt(known), extrapolation_uncertainty * slope_->per_c * beyond_c),
        n - 2);
  }
  const double n = all_.count();
  if (n < 2) return std::nullopt;
  const double spread = std::max(std::sqrt(all_.squares_y() / (n - 1)), least_spread);
  return normal_of_t(std::sqrt(n / (n + 1)) * off / spread, n - 1);
}

}  // namespace softgrip::sysid::health
