#pragma once
// Residual of later records. The prediction is the sum of an unchanged baseline model and effects.

#include <string>
#include <vector>

#include <Eigen/Core>

#include "sysid/changes/base.h"
#include "sysid/changes/base_prediction.h"
#include "sysid/changes/effects.h"
#include "sysid/evidence/units.h"

namespace softgrip::sysid {

/// Later records, and the difference between their readings and the prediction of the baseline model. Two
/// deviations from the healthy logs do not count as a change: a zero offset, and a gain deviation within the
/// spread of the healthy logs. Both are fitted for each record, as for a healthy run, and subtracted.
class LaterReadings {
 public:
  /// @param later  later records, thinned by thinned_for().
  /// @param left  readings minus prediction, averaged over bins.
  LaterReadings(const Base& base, std::vector<Record> later, Binned left);
  /// Returns the readings of one cross-validation unit. The function without() returns the readings of all
  /// other units.
  [[nodiscard]] LaterReadings only(const Units& units, std::size_t unit) const;
  [[nodiscard]] LaterReadings without(const Units& units, std::size_t unit) const;
  /// Returns the readings of all records except one.
  /// @param record  index in records().
  [[nodiscard]] LaterReadings without_record(std::size_t record) const;

  /// Returns the whitened residual of the baseline model with these effects. Zero offset and gain deviation
  /// are fitted and subtracted first. The result contains the rows of rows(), followed by rows with the
  /// penalties of the fitted zero offsets.
  [[nodiscard]] Eigen::VectorXd white(const std::vector<FittedEffect>& effects) const;
  /// Returns the result of white() with one additional row for each record: its fitted gain deviation,
  /// divided by the spread of the gain in the healthy logs.
  [[nodiscard]] Eigen::VectorXd white_and_gain(const std::vector<FittedEffect>& effects) const;
  [[nodiscard]] const WhiteRows& rows() const { return rows_; }
  [[nodiscard]] const Base& base() const { return base_; }
  [[nodiscard]] const std::vector<Record>& records() const { return later_; }
  /// Returns the names of the records whose start state occurs in no healthy record (pressurised or vented).
  /// The healthy records do not show the slow transient after such a start, so this transient does not count
  /// as a change.
  [[nodiscard]] std::vector<std::string> other_starts() const;
  [[nodiscard]] const Binned& left() const { return left_; }
  /// Returns the prediction of the unchanged baseline model, averaged over bins.
  [[nodiscard]] const Binned& plain() const { return plain_; }
  /// Returns the prediction with the effects minus the prediction without the effects, averaged over bins.
  [[nodiscard]] Binned added(const std::vector<FittedEffect>& effects) const;
  /// Returns the root mean square of the residual with these effects. The residual is not whitened. The zero
  /// offset and the gain deviation of each record are fitted and subtracted first.
  [[nodiscard]] double plain_rms(const std::vector<FittedEffect>& effects) const;
  /// Common zero offset [mm] and mean relative gain deviation that are fitted in addition to the effects.
  struct Nuisance {
    double zero_mm = 0, gain = 0;
  };
  [[nodiscard]] Nuisance nuisance(const std::vector<FittedEffect>& effects) const;

 private:
  LaterReadings(const Base& base, std::vector<Record> later, Binned left, Binned plain,
                std::vector<Driven> driven);
  template <class Keep>
  [[nodiscard]] LaterReadings part(Keep keep) const;

  struct Split {
    Eigen::VectorXd left, zeros, gains;  ///< `gains`: relative gain deviation of each record
  };
  [[nodiscard]] Split split(const std::vector<FittedEffect>& effects) const;
  [[nodiscard]] Eigen::VectorXd gains_of(const Eigen::VectorXd& left) const;
  [[nodiscard]] std::vector<double> without_transient(std::size_t record,
                                                      const std::vector<double>& series) const;
  [[nodiscard]] Eigen::VectorXd white_of(const Split& split) const;

  const Base& base_;
  std::vector<Record> later_;
  Binned left_;
  Binned plain_;
  std::vector<Driven> driven_;
  WhiteRows rows_;
  Eigen::VectorXd target_;
  /// `nuisance_` contains the columns of the zero offsets and of the transients after unusual starts.
  /// `solver_` is the matrix that computes the coefficients of these columns.
  Eigen::MatrixXd nuisance_, solver_;
  Eigen::VectorXd price_;  ///< for each column of `nuisance_`, the square root of its penalty
  /// Column r of `motion_` is the whitened prediction of the baseline model for record r, and zero for the
  /// other records. `motion_left_` is `motion_` after the fitted zero offsets and transients are subtracted.
  /// `motion_squares_` contains the scalar products of the columns of both.
  Eigen::MatrixXd motion_, motion_left_, motion_squares_;
};

/// Returns the healthy records with the residual of each cross-validation unit. The unit was left out of the
/// fit.
[[nodiscard]] LaterReadings healthy_readings(const Base& base);

/// Thins the records, averages their residuals over bins, and returns both as later readings.
/// @param records  records at the full sampling rate.
/// @param left  result of residuals_of() for these records.
[[nodiscard]] LaterReadings readings_of(const Base& base, const std::vector<Record>& records,
                                        const std::vector<std::vector<double>>& left);

/// Returns copies of the baseline. The model of copy i was fitted to all cross-validation units except unit
/// i. The differences between the copies show the uncertainty of the baseline model.
[[nodiscard]] std::vector<Base> left_out_bases(const Base& base);

/// Returns the later readings relative to each of these baselines.
/// @param bases  result of left_out_bases().
/// @param later  later records at the full sampling rate.
/// @param left  residuals for the baseline model that was fitted to all units. NaN: the reading is not
/// evaluated.
[[nodiscard]] std::vector<LaterReadings> left_out_readings(const std::vector<Base>& bases,
                                                           const std::vector<Record>& later,
                                                           const std::vector<std::vector<double>>& left);

}  // namespace softgrip::sysid
