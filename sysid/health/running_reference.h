#pragma once
// Computes the reference of an indicator: its mean and standard deviation. If the recordings contain a
// temperature and the indicator depends on it, the reference is a regression line of the indicator over the
// temperature, with the standard deviation about this line.
//
// A value is judged by its residual from the line through all earlier values, in units of the standard
// deviation of this residual (recursive residuals: Brown, Durbin and Evans, Journal of the Royal Statistical
// Society B 37, 1975). For healthy values, these residuals are independent and follow Student's t
// distribution, as residuals from a mean do. The standard deviation includes the uncertainty of the slope. A
// value at a temperature far from all earlier temperatures therefore has little weight. Outside the range of
// the earlier temperatures, no value confirms the line. Half of the extrapolated part of the line is
// therefore taken as its standard deviation. A slope is used only if values that do not depend on the
// temperature would show such a slope with a probability below 0.2 %.

#include <cstddef>
#include <limits>
#include <optional>

namespace softgrip::sysid::health {

/// Converts a Student's t value to a standard normal value with the same probability, by Wallace's formula
/// (Annals of Mathematical Statistics 30, 1959).
/// @param degrees_of_freedom  of the t value, at least 1.
[[nodiscard]] double normal_of_t(double t, double degrees_of_freedom);

/// Sums over a series of pairs (x, y), and sums of the products of each pair with the pair before it. The
/// first pair is subtracted from all pairs.
class SerialSums {
 public:
  void add(double x, double y);
  [[nodiscard]] double count() const { return n_; }
  [[nodiscard]] double mean_x() const { return x0_ + x_ / n_; }
  [[nodiscard]] double mean_y() const { return y0_ + y_ / n_; }
  [[nodiscard]] double squares_x() const;  ///< sum of the squared deviations of x from its mean
  [[nodiscard]] double squares_y() const;
  [[nodiscard]] double slope() const;  ///< slope of the least-squares line; 0 if x is constant
  /// Returns the sum of the squared residuals of y from a line with this slope through the mean of x and y.
  [[nodiscard]] double left(double slope) const;
  /// Returns the lag-one correlation of the residuals from a line with this slope, corrected for bias.
  [[nodiscard]] double correlation(double slope) const;

 private:
  double n_ = 0, x0_ = 0, y0_ = 0;
  double x_ = 0, y_ = 0, xx_ = 0, xy_ = 0, yy_ = 0;
  double last_x_ = 0, last_y_ = 0;
  /// Sums over all points after the first one. Each term is a value of a point times a value of the point
  /// before it.
  double before_xx_ = 0, before_xy_ = 0, before_yx_ = 0, before_yy_ = 0;
};

/// Linear dependence of an indicator on the temperature.
struct TemperatureSlope {
  double per_c = 0;  ///< slope, in the unit of the indicator per degree Celsius
  double standard_error = 0;
  double lowest_c = 0, highest_c = 0;  ///< range of the temperatures at which the indicator was measured
  double mean_c = 0;                   ///< temperature at which the line has the value `mean`
  double mean = 0;

  [[nodiscard]] double at(double temperature_c) const { return mean + per_c * (temperature_c - mean_c); }
};

/// Reference of an indicator that each new value updates.
class RunningReference {
 public:
  static constexpr double no_temperature = std::numeric_limits<double>::quiet_NaN();

  void learn(double value, double temperature_c = no_temperature);
  /// Returns the deviation of the next value from the reference as a standard normal value; nullopt for the
  /// first two values.
  /// @param least_spread  lower limit of the standard deviation that is used, > 0.
  [[nodiscard]] std::optional<double> judge(double value, double least_spread,
                                            double temperature_c = no_temperature) const;
  /// Returns the expected next value. The expected value is the mean if the temperature is unknown or has no
  /// significant effect.
  [[nodiscard]] double expected(double temperature_c = no_temperature) const;

  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(all_.count()); }
  [[nodiscard]] double mean() const { return all_.count() > 0 ? all_.mean_y() : 0; }
  /// Returns the standard deviation of the values about their expected values; 0 for fewer than two values.
  [[nodiscard]] double spread() const;
  /// Returns an estimate of the lag-one correlation of the values, from 0 to 0.95. The estimate is reduced by
  /// half its standard error.
  [[nodiscard]] double persistence() const;
  /// Returns the temperature slope; nullopt if the indicator does not depend significantly on the
  /// temperature.
  [[nodiscard]] const std::optional<TemperatureSlope>& slope() const { return slope_; }

 private:
  [[nodiscard]] std::optional<TemperatureSlope> found_slope() const;

  SerialSums all_;   ///< sums over all values; x is not used and is always 0
  SerialSums warm_;  ///< sums over the values with a known temperature; x is the temperature
  double lowest_c_ = std::numeric_limits<double>::infinity();
  double highest_c_ = -std::numeric_limits<double>::infinity();
  std::optional<TemperatureSlope> slope_;
};

}  // namespace softgrip::sysid::health
