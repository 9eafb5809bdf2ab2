#pragma once
// A self-starting control chart: detects a change of an indicator of a finger, and needs no reference that is
// specified in advance.
//
// The chart compares every value with the mean of the earlier values (running_reference.h), in units of the
// standard deviation of these values. The chart transforms the resulting Student's t value to a standard
// normal value. For independent normal values, the results are independent and standard normal from the third
// value on, for any mean and standard deviation (Hawkins, The Statistician 36, 1987; Quesenberry, Journal of
// Quality Technology 23, 1991). If the values depend significantly on a recorded temperature, the chart
// compares them with their regression line over the temperature. Hawkins describes such charts of
// regression-adjusted variables (Technometrics 33, 1991). Two tests use the results: a two-sided CUSUM (Page,
// Biometrika 41, 1954) for lasting shifts, and a limit for single large values (Lucas, Journal of Quality
// Technology 14, 1982). Each test receives half of the specified false alarm rate.
//
// While a CUSUM exceeds `pause_learning`, the chart adds no values to the reference. Otherwise a change soon
// after the start would become part of the reference before it is detected. The mean of a few reference
// values has an error, and this error shifts all values that are compared with the mean. Therefore, the
// allowance of the CUSUM is increased while learning is paused. The increase is one standard deviation
// divided by the square root of the number of reference values. After an alarm, the chart removes the values
// since the change from the reference.
//
// The weather lasts for days, so the values of neighbouring days are correlated. A CUSUM of correlated values
// drifts farther than a CUSUM of independent values. The chart therefore estimates the lag-one correlation of
// the values and subtracts half the standard error of this estimate. The correlation increases the standard
// deviation of a mean of many values by a factor. The chart divides the values of the CUSUM by this factor
// (Johnson and Bagshaw, Technometrics 16, 1974). 4000 charts with 90 healthy values each were simulated. With
// a correlation of 0.5, 4.4 % of the charts alarmed (24 % without this correction); with 0.7, 15 % alarmed
// (65 % without the correction). The specified false alarm rate applies to independent values.
//
// 200,000 charts of independent values were simulated, with limits for a mean of 32850 values between two
// false alarms. Within the first 90 values, 1.2 times as many charts alarmed as these limits imply. These
// charts did not estimate the correlation. With the estimate of the correlation, fewer charts alarm. A shift
// by 3 standard deviations after 8 healthy values was detected within 30 values in 59 of 100 cases. A shift
// by 3 standard deviations after 20 healthy values was detected in 95 of 100 cases, with a mean delay of 10
// values. All charts detected a shift by 6 standard deviations after 8 values (delay: 9 values) and a shift
// by 5 standard deviations after 20 values (delay: 4 values).

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sysid/health/running_reference.h"

namespace softgrip::sysid::health {

/// Limits of a control chart.
struct ChartLimits {
  double allowance = 0.5;     ///< half the shift that the CUSUM is designed to detect, in standard deviations
  double cusum = 0;           ///< threshold of the CUSUM, in standard deviations
  double single = 0;          ///< limit of the magnitude of a single standard normal value
  double pause_learning = 5;  ///< while a CUSUM exceeds this value, the reference is not updated

  /// @param run_length  mean number of healthy values between false alarms of one chart, at least 20.
  [[nodiscard]] static ChartLimits for_run_length(double run_length);
};

/// Value of an indicator, and the temperature at which it was measured.
struct ChartValue {
  /// Stores a value.
  /// @param at_c  temperature [degC]; if this argument is missing, the temperature is unknown.
  ChartValue(double number, double at_c = RunningReference::no_temperature)
      : value(number), temperature_c(at_c) {}

  double value;
  double temperature_c;
};

/// Values of an indicator at one point in time. Only values with the same key are compared with each other.
/// The key is the recipe. For differences from peer fingers, the key also contains the names of these
/// fingers.
using ChartValues = std::map<std::string, ChartValue>;

struct ChartAlarm {
  std::size_t noticed = 0;  ///< index of the point at which the alarm was raised
  std::size_t since = 0;    ///< index of the first point that the change affects
  double change = 0;        ///< mean deviation from the reference, from the start of the change on
};

/// Control chart of one indicator of one finger. If a point has values of several recipes, each value is
/// compared with the reference of its recipe. The result of the point is the mean of these comparisons. If a
/// change affects only some of the recipes, this mean understates the change.
class ControlChart {
 public:
  /// @param least_spread  lower limit of the standard deviation that is used, > 0.
  ControlChart(ChartLimits limits, double least_spread) : limits_(limits), least_spread_(least_spread) {}

  /// Adds the next point. Returns its deviation from the reference as a standard normal value. Returns
  /// nullopt if no recipe of the point has a reference with at least two values.
  std::optional<double> add(const ChartValues& values);

  /// Takes over an alarm that another chart has raised. Does nothing if this chart already has an alarm whose
  /// change begins at this point or earlier.
  /// @param since  index of the first changed point; 0 and an index that does not exist are ignored.
  void take_alarm(std::size_t since);

  [[nodiscard]] std::size_t points() const { return history_.size(); }
  /// Returns the number of points that were compared with a reference.
  [[nodiscard]] std::size_t judged() const { return judged_; }
  [[nodiscard]] const std::optional<ChartAlarm>& alarm() const { return alarm_; }
  /// Returns the mean deviation of a point from its expected values. Values without a reference are left out.
  [[nodiscard]] std::optional<double> excess(std::size_t point) const { return excess_of(history_[point]); }
  [[nodiscard]] double up() const { return up_; }
  [[nodiscard]] double down() const { return down_; }
  [[nodiscard]] const std::map<std::string, RunningReference>& references() const { return references_; }

 private:
  [[nodiscard]] std::optional<double> excess_of(const ChartValues& values) const;
  /// Updates the CUSUM and the test for single large values.
  /// @param count, persistence  number of reference values and their lag-one correlation, averaged over the
  /// recipes of the point.
  void judge(double z, double count, double persistence);
  void learn(const ChartValues& values);
  void measure_change();
  /// Computes the references from the points before `point` only.
  void forget_since(std::size_t point);

  ChartLimits limits_;
  double least_spread_;
  std::map<std::string, RunningReference> references_;
  std::vector<ChartValues> history_,
      waiting_;  ///< `history_`: all points; `waiting_`: points not yet in a reference
  std::optional<ChartAlarm> alarm_;
  double up_ = 0, down_ = 0;
  std::size_t up_since_ = 0, down_since_ = 0;
  std::size_t judged_ = 0;
};

}  // namespace softgrip::sysid::health
