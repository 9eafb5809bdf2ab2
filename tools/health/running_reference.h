#pragma once
// What is usual of a number: its mean and spread, or, where its recordings hold a temperature and the number
// follows it, a line over the temperature and the spread about that.
//
// A value is judged by what the line of all values before it leaves of it, in units of what that would vary
// by: recursive residuals (Brown, Durbin and Evans, Journal of the Royal Statistical Society B 37, 1975),
// which are independent and Student's t for healthy values, as those of a mean alone are. What is not known
// of the slope yet is in the units, and makes a temperature far from all that were seen weigh little: on a
// line that holds there. Nobody saw that it does, so beyond the temperatures seen half of what the line adds
// is doubted. A slope that may be chance is none: it must lie three standard errors from zero.

#include <cstddef>
#include <limits>
#include <optional>

namespace softgrip::tools::health {

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

}  // namespace softgrip::tools::health
