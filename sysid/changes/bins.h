#pragma once
// Averages series over short bins, and whitens residuals with the statistics of the healthy finger. Errors
// that the healthy finger also has (slow errors, and errors that are large at its input rate) thereby get a
// lower weight.

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Means of each record over bins of equal duration. NaN: there is no reading in the bin.
using Binned = std::vector<std::vector<double>>;

/// Returns the bin length for these records [s]. It is the larger one of `least_s` and two sampling
/// intervals.
[[nodiscard]] double bin_s(const std::vector<Record>& records, double least_s);

/// Returns the number of bins of a record.
[[nodiscard]] std::size_t bin_count(const Record& record, double bin_s);
/// Returns the index of the bin of sample `i`. It may exceed the last bin by rounding.
[[nodiscard]] inline std::size_t bin_of(const Record& record, std::size_t i, double bin_s) {
  return static_cast<std::size_t>((record.time_s[i] - record.time_s.front()) / bin_s + 1e-9);
}

/// Returns the time from the start of a record to the middle of a bin [s].
[[nodiscard]] inline double middle_s(std::size_t bin, double bin_s) {
  return (static_cast<double>(bin) + 0.5) * bin_s;
}

/// Returns the mean of the finite values in every bin.
[[nodiscard]] std::vector<double> binned(const Record& record, const std::vector<double>& series,
                                         double bin_s);

/// Returns the series, cut or extended to the given number of bins. The series of a thinned record may have
/// one bin less than the series of the full record; the last value is then repeated.
[[nodiscard]] std::vector<double> with_bins(std::vector<double> series, std::size_t bins);

/// Returns the difference of two series per record, with equal lengths.
[[nodiscard]] std::vector<std::vector<double>> minus(std::vector<std::vector<double>> from,
                                                     const std::vector<std::vector<double>>& what);

/// Returns the root mean square of the finite values of a series; 0 if there is none.
[[nodiscard]] double rms_of(const Binned& series);

/// Returns the rate |dp/dt| of the drive in bins [kPa/s], after a peak detector that decays with a time
/// constant of 0.5 s.
[[nodiscard]] std::vector<double> peak_rate_of(const Record& record, double bin_s);

/// Whitens a residual in two steps: subtracts the value that an autoregression predicts, and divides the
/// difference by the standard deviation at the current input rate.
struct Whitener {
  std::vector<double> before;  ///< weights of the previous bins in the autoregression; the weight of the
                               ///< nearest bin comes first
  /// Limits between the classes of the input rate (peak_rate_of()), in increasing order [kPa/s].
  std::vector<double> peak_rate_kpa_per_s;
  /// Standard deviation for each class. The list has one element more than the list of limits.
  std::vector<double> spread;

  [[nodiscard]] std::size_t class_of(double peak_rate) const;
  [[nodiscard]] double spread_at(double peak_rate) const {
    return spread[spread.size() > 1 ? class_of(peak_rate) : 0];
  }
};

/// Fits the whitener to a residual by the Yule-Walker equations. The mean of each record is subtracted from
/// the residual first.
/// @param peak_rate  result of peak_rate_of() for the bins of the residual.
/// @param order  number of previous bins in the autoregression.
[[nodiscard]] Whitener whitener_of(Binned residual, const Binned& peak_rate, std::size_t order);

/// The bins of a residual that can be whitened. Each of these bins is a row. A bin can be whitened if it is
/// finite and directly follows at least as many finite bins as the autoregression has weights.
class WhiteRows {
 public:
  struct Row {
    std::size_t record = 0, bin = 0;
    double spread = 1;
  };

  WhiteRows(const Binned& residual, const Binned& peak_rate, Whitener whitener);
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }
  /// Returns the whitened values of a series in the rows of this object. A missing value of the series is
  /// replaced by 0.
  [[nodiscard]] Eigen::VectorXd operator()(const Binned& series) const;

 private:
  Whitener whitener_;
  std::vector<Row> rows_;
};

}  // namespace softgrip::sysid
