#pragma once
// The reference of a number: its mean and spread. If its recordings hold a temperature and the number follows
// it, the reference is a line over the temperature and the spread about this line.
//
// A value is judged by its residual from the line of all values before it, in units of the standard deviation
// of this residual: recursive residuals (Brown, Durbin and Evans, Journal of the Royal Statistical Society
// B 37, 1975). For healthy values they are independent and follow Student's t, as those of a mean alone do.
// The unit includes the uncertainty of the slope, so a value at a temperature far from all earlier ones
// weighs little, if the line holds there. No value confirms this, so outside the earlier temperatures half of
// the contribution of the line counts as uncertain. A slope must lie 3 standard errors from zero; a smaller
// one may be chance and is not used.

#include <cstddef>
#include <limits>
#include <optional>

namespace softgrip::sysid::health {

/// Returns the standard normal equivalent of a Student's t value with these degrees of freedom (at least 1),
/// by Wallace's formula (Annals of Mathematical Statistics 30, 1959).
[[nodiscard]] double normal_of_t(double t, double degrees_of_freedom);

/// Sums of a series y over x and of both with themselves one step before, counted from the first pair.
class SerialSums {
 public:
  void add(double x, double y);
  [[nodiscard]] double count() const { return n_; }
  [[nodiscard]] double mean_x() const { return x0_ + x_ / n_; }
  [[nodiscard]] double mean_y() const { return y0_ + y_ / n_; }
  [[nodiscard]] double squares_x() const;  ///< about the mean
  [[nodiscard]] double squares_y() const;
  [[nodiscard]] double slope() const;  ///< least squares; 0 where x never changes
  /// Squares that a line of this slope through the means leaves.
  [[nodiscard]] double left(double slope) const;
  /// Correlation of what it leaves with the same one step before, less its bias.
  [[nodiscard]] double correlation(double slope) const;

 private:
  double n_ = 0, x0_ = 0, y0_ = 0;
  double x_ = 0, y_ = 0, xx_ = 0, xy_ = 0, yy_ = 0;
  double last_x_ = 0, last_y_ = 0;
  double before_xx_ = 0, before_xy_ = 0, before_yx_ = 0, before_yy_ = 0;  ///< now times before
};

/// How a number follows the temperature.
struct TemperatureSlope {
  double per_c = 0;  ///< the number's unit per degree
  double standard_error = 0;
  double lowest_c = 0, highest_c = 0;  ///< between which it was seen
  double mean_c = 0;                   ///< where the line goes through `mean`
  double mean = 0;

  [[nodiscard]] double at(double temperature_c) const { return mean + per_c * (temperature_c - mean_c); }
};

/// Sums over the values so far.
class RunningReference {
 public:
  static constexpr double no_temperature = std::numeric_limits<double>::quiet_NaN();

  void learn(double value, double temperature_c = no_temperature);
  /// The next value as a standard normal one, nothing before the third.
  /// @param least_spread  what a spread is taken for where it is smaller, > 0.
  [[nodiscard]] std::optional<double> judge(double value, double least_spread,
                                            double temperature_c = no_temperature) const;
  /// Returns the expected next value; the mean if the temperature is unknown or has no significant effect.
  [[nodiscard]] double expected(double temperature_c = no_temperature) const;

  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(all_.count()); }
  [[nodiscard]] double mean() const { return all_.count() > 0 ? all_.mean_y() : 0; }
  /// Standard deviation about what is expected; 0 of fewer than two.
  [[nodiscard]] double spread() const;
  /// How much the next value takes after the last one, from 0 to below 1, as far as that is surely no chance.
  [[nodiscard]] double persistence() const;
  /// Nothing while the number is not known to follow the temperature.
  [[nodiscard]] const std::optional<TemperatureSlope>& slope() const { return slope_; }

 private:
  [[nodiscard]] std::optional<TemperatureSlope> found_slope() const;

  SerialSums all_;   ///< over nothing
  SerialSums warm_;  ///< those with a temperature, over it
  double lowest_c_ = std::numeric_limits<double>::infinity();
  double highest_c_ = -std::numeric_limits<double>::infinity();
  std::optional<TemperatureSlope> slope_;
};

}  // namespace softgrip::sysid::health
