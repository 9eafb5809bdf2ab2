#pragma once
// Errors and fitted effects in the healthy runs. The search for a change compares the later readings with
// these values. The healthy logs may determine the response to the input of the later logs less well. Models
// that predict the healthy runs within their spread can give different predictions for an input unlike the
// healthy ones. The predictions depend on the input and on the estimated state at the start of a log, and not
// on later readings.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "sysid/changes/base.h"
#include "sysid/changes/change.h"
#include "sysid/changes/change_intervals.h"
#include "sysid/changes/later_readings.h"
#include "sysid/evidence/comparison.h"

namespace softgrip::sysid {

/// Mean squared difference between the predictions of the baseline model and those of an alternative model. A
/// difference of the zero offset and a small difference of the gain are subtracted, as for a change.
struct Disagreement {
  double mean_square = 0;  ///< without whitening [mm^2]
  double loss = 0;         ///< of the whitened rows, per row
};

/// Returns the sum of squares of the whitened readings divided by the number of bins. The result is about 1
/// for healthy readings.
[[nodiscard]] double per_bin(const LaterReadings& readings, const Eigen::VectorXd& white);

/// Searches for effects in each healthy cross-validation unit. The baseline model was fitted to the other
/// units.
[[nodiscard]] std::vector<HealthyFits> healthy_fits(const Base& base, bool pressure_is_judged,
                                                    unsigned threads);

/// Computes the tolerance of the search from the error reductions that it finds in the healthy runs.
/// @param more  amount by which an unfamiliar input increases the expected loss per row.
[[nodiscard]] Tolerance tolerance_of(const std::vector<HealthyFits>& healthy, std::size_t runs,
                                     double more = 0);

/// Returns the upper end of the 95 % prediction interval for the error of a further healthy run. The
/// logarithms of the errors are assumed to have a normal distribution (Student's t).
/// @param errors  error in each healthy run, > 0; at least two.
[[nodiscard]] double prediction_bound(const std::vector<double>& errors);

/// Errors of the healthy runs, and the error that is permitted in a further healthy run. The model that
/// predicts a healthy run was fitted to all other healthy runs.
class RunSpread {
 public:
  RunSpread() = default;
  /// @param more  amount by which an unfamiliar input increases the expected squared error.
  RunSpread(const std::vector<HealthyFits>& healthy, std::size_t runs, const Disagreement& more = {});
  [[nodiscard]] double usual_rms() const { return std::sqrt(mean_square_); }
  [[nodiscard]] double allowed_rms() const { return std::sqrt(factor_ * (mean_square_ + more_.mean_square)); }
  /// Returns the factor by which an unfamiliar input increases the permitted mean square error. It is the
  /// larger one of the factors with and without whitening, >= 1.
  [[nodiscard]] double input_factor() const {
    return 1 + std::max(more_.loss, mean_square_ > 0 ? more_.mean_square / mean_square_ : 0.0);
  }
  /// Returns true if the error exceeds the largest error that is expected in a further healthy run.
  /// @param rms  RMS error of the readings; the readings are not whitened.
  /// @param loss  mean square of the whitened readings; about 1 for healthy runs.
  [[nodiscard]] bool is_exceeded(double rms, double loss) const {
    return rms > allowed_rms() || loss > factor_ * (1 + more_.loss);
  }
  /// Returns true if the error is large enough for a search for a change. If there are several healthy runs,
  /// the tolerance of the search prevents false causes. It is then sufficient that one of the two errors
  /// exceeds its prediction bound, or that both errors exceed those of every healthy run.
  [[nodiscard]] bool admits_a_change(double rms, double loss) const {
    return is_exceeded(rms, loss) || rms > rms_bound_ || loss > loss_bound_ ||
           (rms > worst_rms_ && loss > worst_loss_);
  }

 private:
  double factor_ = 1, mean_square_ = 0;
  double rms_bound_ = std::numeric_limits<double>::infinity(), loss_bound_ = rms_bound_;
  double worst_rms_ = rms_bound_, worst_loss_ = rms_bound_;
  Disagreement more_;
};

/// Returns the error that a larger motion adds to the error of a healthy run. The error of a model increases
/// in proportion to the motion, but the noise does not. Its mean square is therefore multiplied by the mean
/// square of the predicted motion of the later records, relative to that of the healthy runs, after the noise
/// is subtracted. The result is zero for a motion that is not larger than the healthy one.
/// @param later  later records at the full sampling rate.
[[nodiscard]] Disagreement added_by_motion(const Base& base, const std::vector<Record>& later);

/// Returns the disagreement about the later records beyond the largest one that is expected about another
/// healthy run (run_to_run_factor()). If there are several alternatives, the largest value is returned. The
/// result is zero for an input like the healthy inputs. The permitted error then stays unchanged. The
/// disagreement is as uncertain as the error of a single run. Therefore the result is multiplied by the ratio
/// of run_to_run_factor() for one run to its value for the healthy runs. The result is at least
/// added_by_motion().
/// @param later  later records at the full sampling rate.
[[nodiscard]] Disagreement added_disagreement(const Base& base, std::vector<Record> later);

/// Sets those residuals of a pressure to NaN that follow an unfamiliar command, up to the longest memory of
/// the baseline model. A command is unfamiliar if its distance from the predicted pressure exceeds the
/// largest distance in the healthy records by more than 25 %. For such a command, the healthy records do not
/// show how fast the air flows.
/// @param later  later records at the full sampling rate.
/// @param left_kpa  residuals, one list per later record.
/// @return share of the residuals that were set to NaN, 0 .. 1.
double remove_unfamiliar_commands(const Base& base, const std::vector<Record>& later,
                                  std::vector<std::vector<double>>& left_kpa);

/// Returns true if the input of the later logs is so unlike the healthy inputs that the answer states it. The
/// input increases the permitted mean square error by more than 10 %, or more than 10 % of the readings are
/// not evaluated.
[[nodiscard]] bool has_unfamiliar_input(const JudgedChange& judged);

}  // namespace softgrip::sysid
