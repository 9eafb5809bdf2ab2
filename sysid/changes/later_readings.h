#pragma once
// Residual that the constant baseline model and effects leave in later records.

#include <string>
#include <vector>

#include <Eigen/Core>

#include "sysid/changes/base.h"
#include "sysid/changes/base_prediction.h"
#include "sysid/changes/effects.h"
#include "sysid/evidence/units.h"

namespace softgrip::sysid {

/// Residuals that the baseline model leaves in later records. Two differences do not count as a change: a
/// difference of the zero offset, and a difference of the gain within the variation of the healthy logs. Both
/// differences are fitted and subtracted.
class LaterReadings {
 public:
  /// @param later  later records, thinned by thinned_for().
  /// @param left  their residuals in bins.
  LaterReadings(const Base& base, std::vector<Record> later, Binned left);
  /// Returns the readings of one unit. The function without() returns the readings of all other units.
  [[nodiscard]] LaterReadings only(const Units& units, std::size_t unit) const;
  [[nodiscard]] LaterReadings without(const Units& units, std::size_t unit) const;

  /// Returns the whitened residual of the baseline model with these effects. Zero and gain are fitted before.
  /// The rows are those of rows(), followed by some rows with the penalties of the fitted zeros.
  [[nodiscard]] Eigen::VectorXd white(const std::vector<FittedEffect>& effects) const;
  /// Returns the result of white() with one more row: the fitted gain that does not count as a change, in
  /// units of the variation of the gain in the healthy logs.
  [[nodiscard]] Eigen::VectorXd white_and_gain(const std::vector<FittedEffect>& effects) const;
  [[nodiscard]] const WhiteRows& rows() const { return rows_; }
  [[nodiscard]] const Base& base() const { return base_; }
  [[nodiscard]] const std::vector<Record>& records() const { return later_; }
  /// Returns the names of the records that begin under pressure although no healthy record does, or without
  /// pressure although no healthy record does. The healthy records do not show the slow transient after such
  /// a start, so this transient does not count as a change.
  [[nodiscard]] std::vector<std::string> other_starts() const;
  [[nodiscard]] const Binned& left() const { return left_; }
  /// Returns the prediction of the unchanged baseline model, in bins.
  [[nodiscard]] const Binned& plain() const { return plain_; }
  /// Returns the difference between two predictions, with and without the effects, in bins.
  [[nodiscard]] Binned added(const std::vector<FittedEffect>& effects) const;
  /// Returns the root mean square of the residual with these effects, without whitening. One zero per record
  /// and one common gain are fitted before.
  [[nodiscard]] double plain_rms(const std::vector<FittedEffect>& effects) const;
  /// Common zero [mm] and relative gain that are fitted in addition to the effects.
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
    Eigen::VectorXd left, zeros;
    double gain = 0;
  };
  [[nodiscard]] Split split(const std::vector<FittedEffect>& effects) const;
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
  /// Columns of the zeros and of the transients after unknown starts, and the matrix that computes their
  /// sizes.
  Eigen::MatrixXd nuisance_, solver_;
  Eigen::VectorXd price_;  ///< for each column of `nuisance_`, the square root of its penalty
  /// `motion_`: motion of the baseline model; `motion_left_`: this motion after subtraction of the fitted
  /// zeros.
  Eigen::VectorXd motion_, motion_left_;
};

/// Returns the healthy records with the residual of each unit under a fit without this unit.
[[nodiscard]] LaterReadings healthy_readings(const Base& base);

/// Returns the readings of later records.
/// @param records  records at the full sampling rate.
/// @param left  result of residuals_of() for these records.
[[nodiscard]] LaterReadings readings_of(const Base& base, const std::vector<Record>& records,
                                        const std::vector<std::vector<double>>& left);

}  // namespace softgrip::sysid
