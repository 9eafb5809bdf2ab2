#pragma once
// The reference of an indicator: its mean and standard deviation. If the recordings contain a temperature and
// the indicator depends on it, the reference is a regression line over the temperature and the standard
// deviation about this line.
//
// A value is judged by its residual from the line of all values before it, in units of the standard deviation
// of this residual: recursive residuals (Brown, Durbin and Evans, Journal of the Royal Statistical Society B
// 37, 1975). For healthy values, these residuals are independent and follow Student's t distribution, as
// residuals from a mean do. The standard deviation includes the uncertainty of the slope, so a value at a
// temperature far from all earlier temperatures has little weight. No earlier value confirms that the line is
// valid there. Outside the earlier temperatures, half of the contribution of the line therefore counts as
// uncertain. A slope is used only if it differs from zero by at least 3 standard errors; a smaller slope may
// be chance.

#include <cstddef>
#include <limits>
#include <optional>

namespace softgrip::sysid::health {

/// Returns the standard normal equivalent of a Student's t value with these degrees of freedom (at least 1),
/// by Wallace's formula (Annals of Mathematical Statistics 30, 1959).
[[nodiscard]] double normal_of_t(double t, double degrees_of_freedom);

/// Sums of a series of pairs (x, y), and of the products of each pair with the previous pair. All values are
/// relative to the first pair.
class SerialSums {
 public:
  void add(double x, double y);
  [[nodiscard]] double count() const { return n_; }
  [[nodiscard]] double mean_x() const { return x0_ + x_ / n_; }
  [[nodiscard]] double mean_y() const { return y0_ + y_ / n_; }
  [[nodiscard]] double squares_x() const;  ///< sum of squares about the mean
  [[nodiscard]] double squares_y() const;
  [[nodiscard]] double slope() const;  ///< of the least-squares line; 0 if x is constant
  /// Returns the sum of the squared residuals from a line of this slope through the means.
  [[nodiscard]] double left(double slope) const;
  /// Returns the lag-one correlation of these residuals, corrected for bias.
  [[nodiscard]] double correlation(double slope) const;

 private:
  double n_ = 0, x0_ = 0, y0_ = 0;
  double x_ = 0, y_ = 0, xx_ = 0, xy_ = 0, yy_ = 0;
  double last_x_ = 0, last_y_ = 0;
  double before_xx_ = 0, before_xy_ = 0, before_yx_ = 0, before_yy_ = 0;  ///< products with the previous pair
};

/// Linear dependence of an indicator on the temperature.
struct TemperatureSlope {
  double per_c = 0;  ///< in the unit of the indicator per degree Celsius
  double standard_error = 0;
  double lowest_c = 0, highest_c = 0;  ///< range of the measured temperatures
  double mean_c = 0;                   ///< temperature at which the line has the value `mean`
  double mean = 0;

  [[nodiscard]] double at(double temperature_c) const { return mean + per_c * (temperature_c - mean_c); }
};

/// Reference that is updated with each value.
class RunningReference {
 public:
  static constexpr double no_temperature = std::numeric_limits<double>::quiet_NaN();

  void learn(double value, double temperature_c = no_temperature);
  /// Returns the deviation of the next value from the reference as a standard normal value; nothing before
  /// the third value. @param least_spread  lower limit of the standard deviation that is used, > 0.
  [[nodiscard]] std::optional<double> judge(double value, double least_spread,
                                            double temperature_c = no_temperature) const;
  /// Returns the expected next value; the mean if the temperature is unknown or has no significant effect.
  [[nodiscard]] double expected(double temperature_c = no_temperature) const;

  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(all_.count()); }
  [[nodiscard]] double mean() const { return all_.count() > 0 ? all_.mean_y() : 0; }
  /// Returns the standard deviation about the expected values; 0 for fewer than two values.
  [[nodiscard]] double spread() const;
  /// Returns a conservative estimate of the lag-one correlation of the values, from 0 to 0.95.
  [[nodiscard]] double persistence() const;
  /// Returns the temperature slope; nothing if no significant dependence on the temperature is known.
  [[nodiscard]] const std::optional<TemperatureSlope>& slope() const { return slope_; }

 private:
  [[nodiscard]] std::optional<TemperatureSlope> found_slope() const;

  SerialSums all_;   ///< all values, with x = 0
  SerialSums warm_;  ///< values with a temperature, with the temperature as x
  double lowest_c_ = std::numeric_limits<double>::infinity();
  double highest_c_ = -std::numeric_limits<double>::infinity();
  std::optional<TemperatureSlope> slope_;
};

}  // namespace softgrip::sysid::health
