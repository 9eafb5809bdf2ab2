#pragma once
// Diagnoses a model. The diagnosis determines the error of the model and its causes, extends the model, and
// measures the error reduction by the extension.
// Computes the error budget of a diagnosis. It consists of the noise variance and of the mean square errors
// of the given, the refitted and the extended model on held-out readings.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

#include "model/model.h"
#include "sysid/diagnosis/evidence/evidence.h"
#include "sysid/diagnosis/gauge/gauge_verdict.h"
#include "sysid/diagnosis/residual/outliers.h"
#include "sysid/diagnosis/residual/sampling.h"
#include "sysid/diagnosis/search/null_calibration.h"
#include "sysid/diagnosis/search/selection.h"
#include "sysid/diagnosis/search/stick_slip.h"
#include "sysid/diagnosis/verdict/named_cause.h"
#include "sysid/diagnosis/verdict/reading_lead.h"
#include "sysid/diagnosis/verdict/valve_findings.h"
#include "sysid/identification/identify.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

enum class Verdict { adequate, recalibrate, cause_found, ambiguous, partly_explained, unexplained };
[[nodiscard]] std::string_view name_of(Verdict verdict);

struct DiagnosisOptions {
  RecordOptions record;
  std::uint64_t seed = 1;
  unsigned threads = 0;
  /// Number of simulated data sets without a cause; 0: no simulation. If the search names a cause, the data
  /// sets show how often the search names a cause by chance.
  std::size_t null_campaigns = 0;
  /// Readings of the sensor at known positions. Not set: no gauge check was made.
  std::optional<GaugeFile> gauge;
  std::function<void(const std::string&)> progress;
};

/// RMSE of the compared models for one run [mm]. If there is only one run, each half of it has its own
/// element.
struct RunError {
  std::string run;
  double given = 0;
  double recalibrated = 0;  ///< RMSE of the refitted model; this run was left out of the fit
  /// RMSE of the extended model; this run was left out of the fit. Without an extended model, the value
  /// equals `recalibrated`.
  double extended = 0;
};

struct Diagnosis {
  /// Verdict from the displacement alone. whole_verdict() also considers the measured pressure.
  Verdict verdict = Verdict::unexplained;
  /// Named causes. Only the verdicts cause_found, ambiguous and partly_explained have named causes. For all
  /// other verdicts, the list is empty.
  std::vector<NamedCause> causes;
  /// Causes that explain only part of the error and are therefore not named.
  std::vector<NamedCause> partial;
  std::vector<CandidateScore> rejected;
  double noise_mm = 0;
  Spread gain;  ///< held-out error reduction by the extended model [%], compared with the refitted model
  /// RMSE of the given model over all readings. The initial state of each record is estimated from its first
  /// readings (sysid/fitting/start_estimate.h).
  double as_given_rmse_mm = 0;
  double recalibrated_rmse_mm = 0;  ///< RMSE of the refitted model on held-out blocks
  double extended_rmse_mm = 0;      ///< RMSE of the extended model on held-out blocks
  /// RMSE of the refitted and of the extended model on complete logs that were left out of the fit. Not set
  /// if there is only one log.
  std::optional<double> recalibrated_other_logs_rmse_mm;
  std::optional<double> extended_other_logs_rmse_mm;
  std::vector<RunError> runs;
  double unexplained_percent = 0;
  /// Result of the search on simulated data without a cause. Set if the caller has requested this test and a
  /// cause was found.
  std::optional<NullCalibration> null_calibration;
  OutlierEvidence outliers;
  SamplingEvidence sampling;
  std::optional<ReadingLead> lead;  ///< lead of the readings; set if the drive of the records was shifted by
                                    ///< the lead
  std::optional<StickSlipEvidence> stick_slip;  ///< result of the test for stick-slip; set if a valve with
                                                ///< stick-slip was found
  /// Dead band of the sticking valve in each log [kPa], from one-step predictions of the closed loops. Set if
  /// every log shows a sticking valve. The causes that the simulations of the search have found are then in
  /// `partial`, although they may be in the extended model.
  std::optional<std::vector<double>> loop_bands_kpa;
  std::optional<GaugeEvidence> gauge;  ///< result of the gauge check; set if the caller has passed gauge
                                       ///< readings
  /// Causes between the command and the measured pressure that are not in `causes`. Set if the pressure was
  /// measured.
  std::optional<ValveFindings> in_valve;
  /// Description of a richer base structure. Empty: the base structure of the given model is sufficient.
  std::string base;
  UnexplainedError unexplained_recalibrated;
  UnexplainedError unexplained_error;
  StructureFit as_given;
  StructureFit recalibrated;
  StructureFit extended;
  /// Model for the daemon. If the given model has the name GIVEN, the name of this model is GIVEN_extended or
  /// GIVEN_recalibrated.
  model::Model extended_model;
  model::Model recalibrated_model;
  std::vector<Record> records;
  std::vector<std::string> warnings;
  /// Causes that were not tested, because no log contains the condition under which the cause has an effect.
  /// Key: id of the cause. Value: description of a recording that would test the cause.
  std::map<std::string, std::string, std::less<>> not_tested;
  std::optional<Evidence> evidence;  ///< conditions on which the errors depend; examine() sets this member
  double wall_s = 0;
  /// Name and wall time of each stage of the diagnosis.
  std::vector<std::pair<std::string, double>> stages_s;
};

/// Returns true if the extended model differs from the refitted model.
[[nodiscard]] inline bool is_extended(const Diagnosis& d) {
  return !d.extended.causes.empty() || !d.base.empty();
}

/// Returns the verdict from the displacement and the measured pressure.
[[nodiscard]] Verdict whole_verdict(const Diagnosis& d);

/// Measures the wall time of each stage of a diagnosis.
class StageClock {
 public:
  explicit StageClock(Diagnosis& diagnosis) : diagnosis_(diagnosis) {}
  /// Ends a stage and stores its wall time. The stage began at the previous call of ended() or, for the first
  /// stage, at the construction of the object.
  void ended(std::string stage) {
    const auto now = std::chrono::steady_clock::now();
    const double took_s = std::chrono::duration<double>(now - began_).count();
    diagnosis_.stages_s.emplace_back(std::move(stage), took_s);
    diagnosis_.wall_s += took_s;
    began_ = now;
  }

 private:
  Diagnosis& diagnosis_;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

/// Diagnoses the given model with the logs. Returns an error sentence if no diagnosis is possible with these
/// logs.
[[nodiscard]] tl::expected<Diagnosis, std::string> diagnose(const std::vector<Log>& logs,
                                                            const model::Model& given,
                                                            const DiagnosisOptions& options = {});

/// Determines the conditions on which the remaining error depends, and adds them to the diagnosis. The
/// verdict does not change.
void examine(Diagnosis& diagnosis, const DiagnosisOptions& options);

/// Returns the verdict as one sentence for a technician.
[[nodiscard]] std::string verdict_sentence(const Diagnosis& diagnosis);

/// Error budget of a diagnosis. All values are mean squares [mm^2].
struct Budget {
  double as_given = 0;
  double recalibrated = 0;
  double extended = 0;
  double noise = 0;

  /// Returns the mean square error of the refitted model minus the noise variance.
  [[nodiscard]] double excess() const { return std::max(recalibrated - noise, 0.0); }
  /// Returns the mean square error of the extended model minus the noise variance.
  [[nodiscard]] double left() const { return std::max(extended - noise, 0.0); }
  /// Returns the share of excess() that one cause explains [%]. The share is the increase of the mean square
  /// error after removal of the cause, divided by excess().
  [[nodiscard]] double share_percent(const NamedCause& named) const {
    return excess() > 0 ? std::clamp(100 * named.gain_mm2.value / excess(), 0.0, 100.0) : 0.0;
  }
};

[[nodiscard]] inline Budget budget_of(const Diagnosis& d) {
  return {d.as_given_rmse_mm * d.as_given_rmse_mm, d.recalibrated_rmse_mm * d.recalibrated_rmse_mm,
          d.extended_rmse_mm * d.extended_rmse_mm, d.noise_mm * d.noise_mm};
}

}  // namespace softgrip::sysid
