#pragma once
// Writes the result of a search into a diagnosis: errors, models, causes with their parameters, and the
// verdict.
// Computes the errors of the compared models for each run of a diagnosis.

#include <string>
#include <utility>
#include <vector>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/search/selection.h"
#include "sysid/diagnosis/verdict/base_findings.h"
#include "sysid/diagnosis/verdict/diagnosis.h"

namespace softgrip::sysid {

class Conclusion {
 public:
  /// @param data  data of the search.
  /// @param diagnosis  receives the result. All arguments must outlive the object.
  Conclusion(const std::vector<Log>& logs, const model::Model& given, const DiagnosisOptions& options,
             const SearchData& data, Diagnosis& diagnosis)
      : logs_(logs), given_(given), options_(options), data_(data), d_(diagnosis) {}

  /// Errors of the given model (`as_given_rmse_mm`) and held-out losses of the refitted model
  /// (`recalibrated`) with the original drive, and held-out losses with the drive shifted in time
  /// (`shifted`).
  struct Unshifted {
    double as_given_rmse_mm = 0;
    BlockLosses recalibrated, shifted;
  };
  /// Informs the object that the drive of the records was shifted in time. The lead of the readings is then
  /// reported as a cause.
  void drive_is_shifted(Unshifted unshifted) { unshifted_ = std::move(unshifted); }

  /// Returns true if the remaining error is too large. If the selection contains causes, the limit is the
  /// error that inexact equations of causes may leave. If the selection contains no causes, the limit is a
  /// share of the noise, and an error that outliers explain does not count.
  [[nodiscard]] bool leaves_too_much(const Selection& selection) const;
  /// Returns true if outliers that were not removed explain the remaining error. Outliers are isolated, but
  /// the effect of a cause is correlated from sample to sample.
  [[nodiscard]] bool left_by_outliers(const UnexplainedError& structure) const;

  /// Writes the refitted model and its errors into the diagnosis.
  void measure_recalibrated(const Selection& selection);
  /// Writes the errors of all models and the extended model into the diagnosis.
  void measure(const Selection& selection, const Division& division);
  /// Searches for causes in simulated data without a cause. Writes into the diagnosis how often these
  /// searches reach the error reduction by the causes of the selection. A shift of the drive does not count.
  void calibrate(const Selection& selection, const Division& division, const NullOptions& nulls);
  /// Describes the causes of the selection, and the causes that were found in the readings before any fit.
  void name(const Selection& selection);
  /// Returns the causes that name() has described.
  [[nodiscard]] std::vector<NamedCause>& causes() { return causes_; }
  /// Writes the verdict into the diagnosis. Call measure() and name() first. If the simulated data without a
  /// cause reject the causes of the selection, only the causes in the readings stay named.
  void conclude(const Selection& selection, const Division& division);
  /// Writes a richer base structure into the diagnosis in place of the extended model. This includes its
  /// errors, its causes and the verdict.
  /// @param selection  causes that were selected on the given base structure.
  void adopt(BaseFindings& base, const Selection& selection);

 private:
  /// Writes the extended model and its errors into the diagnosis.
  void measure_extended(const Selection& selection, const Division& division);
  /// Moves the causes of the selection to the partial causes, and returns true, if the selection was found by
  /// chance and there are causes in the readings. The recalibrated model then is the extended model.
  [[nodiscard]] bool name_readings_alone(const Selection& selection, const Division& division);
  /// If there are outliers or repeated readings, computes the unexplained share so that it includes the error
  /// that these readings explain.
  void count_readings(const UnexplainedError& left);
  /// If the drive was shifted in time, recomputes the error reduction so that it includes the effect of the
  /// shift. The errors of the given and the refitted model are then the errors with the original drive.
  void count_shift(const BlockLosses& extended);
  /// Returns the model with a new name and source. Two models with the same name could not be distinguished
  /// in files and figures. If the drive is the measured pressure and a valve model was found, the blocks of
  /// the valve are added.
  [[nodiscard]] model::Model named_model(model::Model model, const std::string& how) const;
  [[nodiscard]] std::vector<NamedCause> found_in_readings() const;

  const std::vector<Log>& logs_;
  const model::Model& given_;
  const DiagnosisOptions& options_;
  const SearchData& data_;
  Diagnosis& d_;
  Unshifted unshifted_;
  Spread recalibration_gain_;
  std::vector<NamedCause> causes_;
};

/// Returns the RMSE of each run. If there is only one run, returns the RMSE of each half of the run.
/// @param by_unit  result of divide_by_unit() for the records. All losses must refer to its blocks.
[[nodiscard]] std::vector<RunError> run_errors(const std::vector<Record>& records, const Division& by_unit,
                                               const BlockLosses& given, const BlockLosses& recalibrated,
                                               const BlockLosses& extended);

}  // namespace softgrip::sysid
