#pragma once
// Fits one effect to the residual of later records after a frozen base.

#include <vector>

#include <Eigen/Core>

#include "sysid/changes/base.h"
#include "sysid/changes/effects.h"
#include "sysid/evidence/units.h"

namespace softgrip::sysid {

/// An effect with its numbers.
struct FittedEffect {
  Effect effect;
  std::vector<double> numbers;
};

/// Residuals of later records after the base, without the differences that are not a change: the zero, and a
/// gain within the variation of the healthy logs.
class LaterReadings {
 public:
  /// @param later  thinned_for() the base. @param left  their residual after the base, in bins.
  LaterReadings(const Base& base, std::vector<Record> later, Binned left);
  /// Returns the readings of one unit, or those of all other units.
  [[nodiscard]] LaterReadings only(const Units& units, std::size_t unit) const;
  [[nodiscard]] LaterReadings without(const Units& units, std::size_t unit) const;

  /// Returns the whitened residual of the base with these effects, after the fit of zero and gain. It has a
  /// few rows more than rows(): the penalties of zero and gain.
  [[nodiscard]] Eigen::VectorXd white(const std::vector<FittedEffect>& effects) const;
  /// Returns white() and, as the last row, the gain that is not a change, in units of the variation of the
  /// healthy logs.
  [[nodiscard]] Eigen::VectorXd white_and_gain(const std::vector<FittedEffect>& effects) const;
  [[nodiscard]] const WhiteRows& rows() const { return rows_; }
  [[nodiscard]] const Base& base() const { return base_; }
  [[nodiscard]] const std::vector<Record>& records() const { return later_; }
  /// Returns the names of the records whose start no healthy record has: under pressure, or without pressure.
  /// The healthy records do not show the slow transient of such a start, so it is not a change.
  [[nodiscard]] std::vector<std::string> other_starts() const;
  [[nodiscard]] const Binned& left() const { return left_; }
  /// Prediction of the unchanged base, in bins.
  [[nodiscard]] const Binned& plain() const { return plain_; }
  /// Difference of the prediction with and without the effects, in bins.
  [[nodiscard]] Binned added(const std::vector<FittedEffect>& effects) const;
  /// Returns the root mean square of the residual with these effects, not whitened. The zero of each record
  /// and the common gain are fitted.
  [[nodiscard]] double plain_rms(const std::vector<FittedEffect>& effects) const;
  /// Zero and gain that are fitted beside the effects: common zero [mm], relative gain.
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
  /// Columns of zeros and of transients after other starts, and the matrix that gives their sizes.
  Eigen::MatrixXd nuisance_, solver_;
  Eigen::VectorXd price_;                 ///< root of the penalty of each
  Eigen::VectorXd motion_, motion_left_;  ///< motion of the base, complete and after the fit of the zeros
};

/// Returns the records of the base with its residual for each unit that is left out of the fit.
[[nodiscard]] LaterReadings healthy_readings(const Base& base);

/// @param records  at full rate. @param left  residuals_of() them.
[[nodiscard]] LaterReadings readings_of(const Base& base, const std::vector<Record>& records,
                                        const std::vector<std::vector<double>>& left);

struct EffectFit {
  FittedEffect fitted;
  double sum_of_squares = 0;
  Eigen::VectorXd white;
};

/// Fits an effect from the best of its starts. The other effects are fixed.
/// @param without  readings.white(others).
[[nodiscard]] EffectFit fit_effect(const LaterReadings& readings, const Effect& effect,
                                   const std::vector<FittedEffect>& others, const Eigen::VectorXd& without);

/// Returns the difference of a number for a derivative: a small share of its value or of its usual value,
/// within its bounds.
[[nodiscard]] double small_move(const FittedEffect& fitted, std::size_t number);

[[nodiscard]] Extension extension_of(const std::vector<FittedEffect>& effects);

}  // namespace softgrip::sysid
