#pragma once
// Averages series over short bins, and whitens residuals with the statistics of the healthy finger. Errors
// that are slow or frequent in the healthy logs thereby get a lower weight.

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Means of each record over bins of equal duration. NaN: the bin contains no reading.
using Binned = std::vector<std::vector<double>>;

/// Returns the bin length for these records [s]: `least_s`, or two sampling intervals if these are longer.
[[nodiscard]] double bin_s(const std::vector<Record>& records, double least_s);

/// Returns the mean of the finite values in every bin.
[[nodiscard]] std::vector<double> binned(const Record& record, const std::vector<double>& series,
                                         double bin_s);

/// Returns the series with the given number of bins. The series of a thinned record may have one bin less;
/// its last value is then repeated.
[[nodiscard]] std::vector<double> with_bins(std::vector<double> series, std::size_t bins);

/// Returns the rate |dp/dt| of the drive in bins [kPa/s], after a peak detector that decays with a time
/// constant of 0.5 s.
[[nodiscard]] std::vector<double> peak_rate_of(const Record& record, double bin_s);

/// Whitens a residual: computes the error of its prediction by an autoregression and divides it by the
/// standard deviation for the current input rate.
struct Whitener {
  std::vector<double> before;  ///< weights of the previous bins; the nearest bin comes first
  /// Limits between the classes of peak_rate_of(), in increasing order.
  std::vector<double> peak_rate_kpa_per_s;
  /// Standard deviation for each class; it has one element more than the list of limits.
  std::vector<double> spread;

  [[nodiscard]] std::size_t class_of(double peak_rate) const;
  [[nodiscard]] double spread_at(double peak_rate) const {
    return spread[spread.size() > 1 ? class_of(peak_rate) : 0];
  }
};

/// Fits the whitener to a residual by the Yule-Walker equations. Before, the mean of each record is
/// subtracted.
/// @param peak_rate  peak_rate_of() in the same bins.
[[nodiscard]] Whitener whitener_of(Binned residual, const Binned& peak_rate, std::size_t order);

/// The bins of a residual that can be whitened, because enough finite bins come before them. Each such bin is
/// a row.
class WhiteRows {
 public:
  struct Row {
    std::size_t record = 0, bin = 0;
    double spread = 1;
  };

  WhiteRows(const Binned& residual, const Binned& peak_rate, Whitener whitener);
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }
  /// Returns the whitened values of a series in these rows. A missing value of the series counts as 0.
  [[nodiscard]] Eigen::VectorXd operator()(const Binned& series) const;

 private:
  Whitener whitener_;
  std::vector<Row> rows_;
};

}  // namespace softgrip::sysid
