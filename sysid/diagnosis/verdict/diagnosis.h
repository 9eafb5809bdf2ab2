#pragma once
// Diagnoses a model: determines its error and the causes of this error, extends the model, and measures the
// error reduction.
// Computes the error budget of a diagnosis: the mean square errors of the given, the refitted and the
// extended model on held-out readings, and the noise variance.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
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
#include "sysid/diagnosis/search/stick_slip_selection.h"
#include "sysid/diagnosis/verdict/named_cause.h"
#include "sysid/diagnosis/verdict/reading_lead.h"
#include "sysid/diagnosis/verdict/valve_findings.h"
#include "sysid/identification/identify.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

enum class Verdict { adequate, recalibrate, cause_found, ambiguous, partly_explained, unexplained };
[[nodiscard]] const char* name_of(Verdict verdict);

struct DiagnosisOptions {
  RecordOptions record;
  std::uint64_t seed = 1;
  unsigned threads = 0;
  /// Number of simulated data sets without a cause. If the search names a cause, these data sets show how
  /// often the search names one by chance; 0: no simulation.
  std::size_t null_campaigns = 0;
  /// Readings of the sensor at known positions. Not set: the operator has made no gauge check.
  std::optional<GaugeFile> gauge;
  std::function<void(const std::string&)> progress;
};

/// RMSE of the models that a diagnosis compares, for one run [mm]. If there is a single run, each half of the
/// run has its own element.
struct RunError {
  std::string run;
  double given = 0;
  double recalibrated = 0;  ///< RMSE of the refitted model, which was fitted to the other runs
  /// RMSE of the extended model, which was fitted to the other runs; equal to `recalibrated` if there is no
  /// extended model.
  double extended = 0;
};

struct Diagnosis {
  /// Verdict from the displacement only; whole_verdict() also uses the measured pressure.
  Verdict verdict = Verdict::unexplained;
  /// Named causes; empty unless the verdict is cause_found, ambiguous or partly_explained.
  std::vector<NamedCause> causes;
  /// Causes that explain only part of the error, for the verdict unexplained.
  std::vector<NamedCause> partial;
  std::vector<CandidateScore> rejected;
  double noise_mm = 0;
  Spread gain;  ///< held-out error reduction by the extended model, relative to the refitted model [%]
  /// RMSE of the given model over all readings. The initial states are estimated from the first readings
  /// (sysid/fitting/start_estimate.h).
  double as_given_rmse_mm = 0;
  double recalibrated_rmse_mm = 0;  ///< RMSE of the refitted model on held-out blocks
  double extended_rmse_mm = 0;      ///< RMSE of the extended model on held-out blocks
  /// RMSE of the refitted and of the extended model on logs that were completely held out; not set if there
  /// is a single log.
  std::optional<double> recalibrated_other_logs_rmse_mm;
  std::optional<double> extended_other_logs_rmse_mm;
  std::vector<RunError> runs;
  double unexplained_percent = 0;
  /// Result of the search on data without a cause; set if this test was requested and a cause was found.
  std::optional<NullCalibration> null_calibration;
  OutlierEvidence outliers;
  SamplingEvidence sampling;
  std::optional<ReadingLead> lead;  ///< lead of the readings; set if the drive of the records was shifted
  std::optional<StickSlipEvidence> stick_slip;  ///< set if the named dead band shows stick-slip
  std::optional<GaugeEvidence> gauge;  ///< result of the gauge check; set if there are gauge readings
  /// Causes between the command and the measured pressure, except those in `causes`; set if the pressure was
  /// measured.
  std::optional<ValveFindings> in_valve;
  /// Description of a richer base structure; empty: the given base structure is sufficient.
  std::string base;
  UnexplainedError unexplained_recalibrated;
  UnexplainedError unexplained_error;
  StructureFit as_given;
  StructureFit recalibrated;
  StructureFit extended;
  /// Model for the daemon; its name is GIVEN_extended, where GIVEN is the name of the given model.
  model::Model extended_model;
  model::Model recalibrated_model;
  std::vector<Record> records;
  std::vector<std::string> warnings;
  /// Causes that were not tested, by id, because the logs never contain the condition in which the cause has
  /// an effect. The value describes the recording that would test the cause.
  std::map<std::string, std::string, std::less<>> not_tested;
  std::optional<Evidence> evidence;  ///< conditions on which the errors depend; set by examine()
  double wall_s = 0;
  /// For each stage of the diagnosis, its name and its wall time.
  std::vector<std::pair<std::string, double>> stages_s;
};

/// Returns true if the extended model differs from the refitted model.
[[nodiscard]] inline bool is_extended(const Diagnosis& d) {
  return !d.extended.causes.empty() || !d.base.empty();
}

/// Returns the verdict from the displacement and from the measured pressure.
[[nodiscard]] Verdict whole_verdict(const Diagnosis& d);

/// Measures the wall times of consecutive stages of a diagnosis.
class StageClock {
 public:
  explicit StageClock(Diagnosis& diagnosis) : diagnosis_(diagnosis) {}
  /// Ends a stage. Its time is the time since the previous call of ended(), or since the construction.
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

/// Diagnoses the given model from the logs. Returns an error sentence if the logs cannot be diagnosed.
[[nodiscard]] tl::expected<Diagnosis, std::string> diagnose(const std::vector<Log>& logs,
                                                            const model::Model& given,
                                                            const DiagnosisOptions& options = {});

/// Adds to a diagnosis the conditions on which the remaining error depends. The verdict does not change.
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
  /// Returns the share of excess() that one cause explains, from 0 to 100 %. This share is the increase of
  /// the mean square error when the cause is removed, divided by excess().
  [[nodiscard]] double share_percent(const NamedCause& named) const {
    return excess() > 0 ? std::clamp(100 * named.gain_mm2.value / excess(), 0.0, 100.0) : 0.0;
  }
};

[[nodiscard]] inline Budget budget_of(const Diagnosis& d) {
  return {d.as_given_rmse_mm * d.as_given_rmse_mm, d.recalibrated_rmse_mm * d.recalibrated_rmse_mm,
          d.extended_rmse_mm * d.extended_rmse_mm, d.noise_mm * d.noise_mm};
}

}  // namespace softgrip::sysid
