#pragma once
// A self-starting control chart: detects a change of the values of a healthy finger without a given
// reference.
//
// The chart compares every value with the earlier values (running_reference.h), in units of their standard
// deviation. It transforms the resulting Student's t value to a standard normal value. For independent normal
// values, the results are independent and standard normal from the third value on, for any mean and standard
// deviation (Hawkins, The Statistician 36, 1987; Quesenberry, Journal of Quality Technology 23, 1991). If the
// values depend significantly on a recorded temperature, the chart compares them with their regression line
// over the temperature (control charts of regression-adjusted variables: Hawkins, Technometrics 33, 1991).
// Two tests use the results: a two-sided CUSUM (Page, Biometrika 41, 1954) for lasting shifts, and a limit
// for single large values (Lucas, Journal of Quality Technology 14, 1982). Each test receives half of the
// specified false alarm rate.
//
// While a CUSUM exceeds `pause_learning`, the chart adds no values to the reference. Otherwise a change soon
// after the start would become part of the reference before it is detected. All values that are compared with
// the same few reference values share the error of this reference. While learning is paused, the allowance is
// therefore larger by one standard deviation divided by the square root of the number of reference values.
// After an alarm, the chart removes the values since the change from the reference.
//
// Weather lasts for days, so the values are correlated, and the CUSUM of correlated values drifts farther
// than that of independent values. The chart estimates the correlation (lag one, minus half its standard
// error). It scales the values of the CUSUM by the standard deviation of a mean over many values with this
// correlation, after Johnson and Bagshaw (Technometrics 16, 1974). 4000 charts with 90 healthy values each
// were simulated. With a correlation of 0.5, 4.4 % of the charts alarmed (24 % without this correction); with
// 0.7, 15 % (65 %). The stated rate applies to independent values.
//
// 200,000 charts of independent values were simulated for a mean of 32850 values between two false alarms.
// Within the first 90 values, 1.2 times as many of them alarmed as this rate implies. These charts did not
// estimate the correlation; the estimate reduces the number of alarms. The charts detected a shift by 3
// standard deviations within 30 values in 59 of 100 cases if it came after 8 healthy values. After 20 healthy
// values, they detected it in 95 of 100 cases, with a mean delay of 10 values. All charts detected a shift by
// 6 standard deviations after 8 values (delay: 9 values) and a shift by 5 standard deviations after 20 values
// (delay: 4 values).

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sysid/health/running_reference.h"

namespace softgrip::sysid::health {

/// Limits of a chart.
struct ChartLimits {
  double allowance = 0.5;     ///< half the shift to be detected, in standard deviations
  double cusum = 0;           ///< threshold of the CUSUM, in standard deviations
  double single = 0;          ///< limit of the magnitude of a single standard normal value
  double pause_learning = 5;  ///< learning pauses while a CUSUM exceeds this value

  /// @param run_length  mean number of healthy values between false alarms of one chart, at least 20.
  [[nodiscard]] static ChartLimits for_run_length(double run_length);
};

/// Value of an indicator, and the temperature at which it was measured.
struct ChartValue {
  /// Holds a value. @param at_c  [degC]; not given: the temperature is unknown.
  ChartValue(double number, double at_c = RunningReference::no_temperature)
      : value(number), temperature_c(at_c) {}

  double value;
  double temperature_c;
};

/// Values of one point in time. Only values with the same key are comparable: the recipe, or, for differences
/// from peer fingers, the recipe and the names of these fingers.
using ChartValues = std::map<std::string, ChartValue>;

struct ChartAlarm {
  std::size_t noticed = 0;  ///< index of the point at which the alarm was raised
  std::size_t since = 0;    ///< index of the first changed point
  double change = 0;        ///< mean deviation from the reference since the change
};

/// Control chart of one indicator of one finger. If a point has values of several recipes, each value is
/// compared with the reference of its recipe, and the mean of the results is the result of the point. If the
/// recipes do not change together, the mean is conservative.
class ControlChart {
 public:
  /// @param least_spread  lower limit of the standard deviation that is used, > 0.
  ControlChart(ChartLimits limits, double least_spread) : limits_(limits), least_spread_(least_spread) {}

  /// Adds the next point. Returns its standard normal value, or nothing if no reference has at least two
  /// values.
  std::optional<double> add(const ChartValues& values);

  /// Takes over an alarm that another chart has raised. Does nothing if this chart has an earlier alarm.
  /// @param since  index of the first changed point; 0 and an index that does not exist are ignored.
  void take_alarm(std::size_t since);

  [[nodiscard]] std::size_t points() const { return history_.size(); }
  /// Returns the number of points that were compared with a reference.
  [[nodiscard]] std::size_t judged() const { return judged_; }
  [[nodiscard]] const std::optional<ChartAlarm>& alarm() const { return alarm_; }
  /// Returns the mean deviation of a point from the expected values, over its values that have a reference.
  [[nodiscard]] std::optional<double> excess(std::size_t point) const { return excess_of(history_[point]); }
  [[nodiscard]] double up() const { return up_; }
  [[nodiscard]] double down() const { return down_; }
  [[nodiscard]] const std::map<std::string, RunningReference>& references() const { return references_; }

 private:
  [[nodiscard]] std::optional<double> excess_of(const ChartValues& values) const;
  /// Updates both tests. @param count, persistence  of the references of the point, averaged over its
  /// recipes.
  void judge(double z, double count, double persistence);
  void learn(const ChartValues& values);
  void measure_change();
  /// Computes the references again from the points before `point`.
  void forget_since(std::size_t point);

  ChartLimits limits_;
  double least_spread_;
  std::map<std::string, RunningReference> references_;
  std::vector<ChartValues> history_, waiting_;  ///< all points; the points that are not yet in the references
  std::optional<ChartAlarm> alarm_;
  double up_ = 0, down_ = 0;
  std::size_t up_since_ = 0, down_since_ = 0;
  std::size_t judged_ = 0;
};

}  // namespace softgrip::sysid::health
