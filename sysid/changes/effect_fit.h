#pragma once
// One effect fitted to what a frozen base leaves of later records.

#include <vector>

#include <Eigen/Core>

#include "sysid/changes/base.h"
#include "sysid/changes/effects.h"
#include "sysid/evidence/units.h"

namespace softgrip::sysid {

/// An effect with numbers.
struct FittedEffect {
  Effect effect;
  std::vector<double> numbers;
};

/// Residuals of later records after the base, without the differences that are no change: the zero, and a
/// gain within the variation of the healthy logs.
class LaterReadings {
 public:
  /// @param later  thinned_for() the base. @param left  what the base leaves of them, in bins.
  LaterReadings(const Base& base, std::vector<Record> later, Binned left);
  /// The readings of one unit, or all but those of it.
  [[nodiscard]] LaterReadings only(const Units& units, std::size_t unit) const;
  [[nodiscard]] LaterReadings without(const Units& units, std::size_t unit) const;

  /// Whitened residual of the base with these effects, without what zero and gain take; a few rows more than
  /// rows(), for what zero and gain cost.
  [[nodiscard]] Eigen::VectorXd white(const std::vector<FittedEffect>& effects) const;
  /// white(), and behind it the gain that counts as no change, in units of how much the healthy logs vary.
  [[nodiscard]] Eigen::VectorXd white_and_gain(const std::vector<FittedEffect>& effects) const;
  [[nodiscard]] const WhiteRows& rows() const { return rows_; }
  [[nodiscard]] const Base& base() const { return base_; }
  [[nodiscard]] const std::vector<Record>& records() const { return later_; }
  /// Names of the records that begin as no healthy record does: under pressure, or without pressure. The
  /// healthy records do not show their slow transient, so it is no change, either.
  [[nodiscard]] std::vector<std::string> other_starts() const;
  [[nodiscard]] const Binned& left() const { return left_; }
  /// Prediction of the unchanged base, in bins.
  [[nodiscard]] const Binned& plain() const { return plain_; }
  /// Difference of the prediction with and without the effects, in bins.
  [[nodiscard]] Binned added(const std::vector<FittedEffect>& effects) const;
  /// Root mean square of what is left of the readings with these effects, as they are and not whitened;
  /// every record's zero and the common gain each at their best.
  [[nodiscard]] double plain_rms(const std::vector<FittedEffect>& effects) const;
  /// Zero and gain that go with the effects: common zero [mm], relative gain.
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
  /// Columns of zeros and of transients after other starts; what turns a residual into their sizes.
  Eigen::MatrixXd nuisance_, solver_;
  Eigen::VectorXd price_;                 ///< root of what each costs
  Eigen::VectorXd motion_, motion_left_;  ///< the base's own motion, whole and without what zeros take
};

/// The base's own records with what it leaves of each unit that is left out.
[[nodiscard]] LaterReadings healthy_readings(const Base& base);

/// @param records  at full rate. @param left  residuals_of() them.
[[nodiscard]] LaterReadings readings_of(const Base& base, const std::vector<Record>& records,
                                        const std::vector<std::vector<double>>& left);

struct EffectFit {
  FittedEffect fitted;
  double sum_of_squares = 0;
  Eigen::VectorXd white;
};

/// From the best of its starts, the effects so far kept as they are.
/// @param without  readings.white(others).
[[nodiscard]] EffectFit fit_effect(const LaterReadings& readings, const Effect& effect,
                                   const std::vector<FittedEffect>& others, const Eigen::VectorXd& without);

/// By how much a number of an effect is moved for a slope: little of what it is or usually is, and not out of
/// its bounds.
[[nodiscard]] double small_move(const FittedEffect& fitted, std::size_t number);

[[nodiscard]] Extension extension_of(const std::vector<FittedEffect>& effects);

}  // namespace softgrip::sysid
