#pragma once
// Series averaged over short bins, and the filter that makes what a healthy base leaves white: what is slow
// and often wrong counts less than what is neither.

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Means of each record over intervals of equal duration; NaN: no reading in the interval.
using Binned = std::vector<std::vector<double>>;

/// The bin of records: `least_s`, or two samples where they are farther apart [s].
[[nodiscard]] double bin_s(const std::vector<Record>& records, double least_s);

/// The mean of the finite values in every bin.
[[nodiscard]] std::vector<double> binned(const Record& record, const std::vector<double>& series,
                                         double bin_s);

/// The series with as many bins as another one: a thinned record may end a bin sooner. Its last value goes
/// on.
[[nodiscard]] std::vector<double> with_bins(std::vector<double> series, std::size_t bins);

/// How fast the drive moves or has moved half a second before, in bins [kPa/s].
[[nodiscard]] std::vector<double> peak_rate_of(const Record& record, double bin_s);

/// Prediction error of an autoregression, in units of its own spread at this rate of the input.
struct Whitener {
  std::vector<double> before;               ///< weights of the bins before, the nearest first
  std::vector<double> peak_rate_kpa_per_s;  ///< from where the next class of peak_rate begins, ascending
  std::vector<double> spread;               ///< by class, one more

  [[nodiscard]] std::size_t class_of(double peak_rate) const;
  [[nodiscard]] double spread_at(double peak_rate) const {
    return spread[spread.size() > 1 ? class_of(peak_rate) : 0];
  }
};

/// By Yule's and Walker's equations from a residual; every record's mean is taken away first.
/// @param peak_rate  of the same bins.
[[nodiscard]] Whitener whitener_of(Binned residual, const Binned& peak_rate, std::size_t order);

/// The rows of a residual that can be whitened: those with enough finite bins before them.
class WhiteRows {
 public:
  struct Row {
    std::size_t record = 0, bin = 0;
    double spread = 1;
  };

  WhiteRows(const Binned& residual, const Binned& peak_rate, Whitener whitener);
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }
  /// A series whitened; what is missing in it counts as 0.
  [[nodiscard]] Eigen::VectorXd operator()(const Binned& series) const;

 private:
  Whitener whitener_;
  std::vector<Row> rows_;
};

}  // namespace softgrip::sysid
