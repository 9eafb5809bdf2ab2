#pragma once
// Writes the result of a search into a diagnosis: the errors and the models, the causes with their
// parameters, and the verdict.
// Computes the error of each run for the models that a diagnosis compares.

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
  /// @param data  data of the search; `diagnosis` receives the result. All arguments must outlive the object.
  Conclusion(const std::vector<Log>& logs, const model::Model& given, const DiagnosisOptions& options,
             const SearchData& data, Diagnosis& diagnosis)
      : logs_(logs), given_(given), options_(options), data_(data), d_(diagnosis) {}

  /// Errors of the models with the original drive, and held-out losses with the shifted drive. They are
  /// needed if the drive was shifted in time.
  struct Unshifted {
    double as_given_rmse_mm = 0;
    BlockLosses recalibrated, shifted;
  };
  /// Notes that the drive of the records was shifted in time. The lead of the readings is then one of the
  /// causes.
  void drive_is_shifted(Unshifted unshifted) { unshifted_ = std::move(unshifted); }

  /// Returns true if the error that remains with the selection exceeds a limit. For a selection with causes,
  /// the limit is the error that inexact equations of the causes may leave. For a selection without causes,
  /// the limit is a share of the noise, and wrong readings do not count as an error.
  [[nodiscard]] bool leaves_too_much(const Selection& selection) const;
  /// Returns true if the remaining error is due to wrong readings that were not found. Wrong readings are
  /// isolated. The effect of a cause, in contrast, is correlated from sample to sample.
  [[nodiscard]] bool left_by_outliers(const UnexplainedError& structure) const;

  /// Writes the refitted model and its errors into the diagnosis.
  void measure_recalibrated(const Selection& selection);
  /// Writes the errors of all models and the extended model into the diagnosis.
  void measure(const Selection& selection, const Division& division);
  /// Describes the causes of the selection and the causes that were found in the readings.
  void name(const Selection& selection);
  /// Returns the causes that name() has described.
  [[nodiscard]] std::vector<NamedCause>& causes() { return causes_; }
  /// Writes the verdict into the diagnosis. measure() and name() must have been called before.
  void conclude(const Selection& selection);
  /// Writes a richer base structure with its errors, causes and verdict into the diagnosis, instead of the
  /// extended model.
  /// @param selection  selection on the given base structure.
  void adopt(BaseFindings& base, const Selection& selection);

 private:
  /// Corrects the error reduction if the drive was shifted in time, so that it includes the effect of the
  /// shift. The errors of the given and the refitted model are set to the errors with the original drive.
  void count_shift(const BlockLosses& extended);
  /// Returns the model with a new name, because two models with the same name would be ambiguous in files and
  /// figures.
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

/// Returns the RMSE of each run. If there is a single run, returns the RMSE of each half.
/// @param by_unit  result of divide_by_unit() for the records. The losses must have been computed for its
/// blocks.
[[nodiscard]] std::vector<RunError> run_errors(const std::vector<Record>& records, const Division& by_unit,
                                               const BlockLosses& given, const BlockLosses& recalibrated,
                                               const BlockLosses& extended);

}  // namespace softgrip::sysid
