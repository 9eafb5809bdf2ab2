#pragma once
// Diagnoses a model: determines its error and the cause, extends it, and measures the error reduction.

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
  /// Number of simulated data sets without a cause that calibrate the search if it names a cause; 0: none.
  std::size_t null_campaigns = 0;
  /// Sensor readings at known positions; empty: the operator has measured none.
  std::optional<GaugeFile> gauge;
  std::function<void(const std::string&)> progress;
};

/// RMSE of one run, or of one half if there is a single run, for the models that a diagnosis compares [mm].
struct RunError {
  std::string run;
  double given = 0;
  double recalibrated = 0;  ///< fitted to the other runs
  double extended = 0;      ///< fitted to the other runs; equal to `recalibrated` without an extended model
};

struct Diagnosis {
  Verdict verdict = Verdict::unexplained;  ///< verdict from the displacement alone; see whole_verdict()
  std::vector<NamedCause> causes;          ///< named causes for the verdicts cause_found, ambiguous and
                                           ///< partly_explained
  std::vector<NamedCause> partial;         ///< partial explanations of an unexplained error
  std::vector<CandidateScore> rejected;
  double noise_mm = 0;
  Spread gain;  ///< held-out error reduction by the extended model, relative to the refitted model [%]
  double as_given_rmse_mm = 0;  ///< RMSE over all readings; initial states by sysid/fitting/start_estimate.h
  double recalibrated_rmse_mm = 0;  ///< RMSE on held-out blocks
  double extended_rmse_mm = 0;      ///< RMSE on held-out blocks
  /// RMSE on logs that were held out completely; empty if there is a single log.
  std::optional<double> recalibrated_other_logs_rmse_mm;
  std::optional<double> extended_other_logs_rmse_mm;
  std::vector<RunError> runs;
  double unexplained_percent = 0;
  std::optional<NullCalibration> null_calibration;  ///< present if requested and if a cause was found
  OutlierEvidence outliers;
  SamplingEvidence sampling;
  std::optional<ReadingLead> lead;              ///< present if the drive of the records was shifted
  std::optional<StickSlipEvidence> stick_slip;  ///< present if the named dead band shows stick-slip
  std::optional<GaugeEvidence> gauge;           ///< present if gauge readings were given
  std::optional<ValveFindings> in_valve;  ///< present if the pressure was measured; contains none of `causes`
  /// components of a richer base structure; empty: the given base structure is sufficient
  std::string base;
  UnexplainedError unexplained_recalibrated;
  UnexplainedError unexplained_error;
  StructureFit as_given;
  StructureFit recalibrated;
  StructureFit extended;
  model::Model extended_model;  ///< model for the daemon, named GIVEN_extended
  model::Model recalibrated_model;
  std::vector<Record> records;
  std::vector<std::string> warnings;
  /// Untested causes by id: the logs never contain the condition in which the cause has an effect. The value
  /// names the recording that would test the cause.
  std::map<std::string, std::string, std::less<>> not_tested;
  std::optional<Evidence> evidence;  ///< conditions on which the errors depend; see examine()
  double wall_s = 0;
  std::vector<std::pair<std::string, double>> stages_s;  ///< wall time by stage
};

/// Returns true if the extended model differs from the refitted one.
[[nodiscard]] inline bool is_extended(const Diagnosis& d) {
  return !d.extended.causes.empty() || !d.base.empty();
}

/// Returns the verdict that also includes the causes found in the measured pressure.
[[nodiscard]] Verdict whole_verdict(const Diagnosis& d);

/// Measures the wall time of the stages of a diagnosis in sequence.
class StageClock {
 public:
  explicit StageClock(Diagnosis& diagnosis) : diagnosis_(diagnosis) {}
  /// Assigns the time since the construction or since the last call of ended() to this stage.
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

/// Returns an error sentence if the logs cannot be diagnosed.
[[nodiscard]] tl::expected<Diagnosis, std::string> diagnose(const std::vector<Log>& logs,
                                                            const model::Model& given,
                                                            const DiagnosisOptions& options = {});

/// Adds the evidence to a diagnosis: the conditions on which the remaining error depends. The verdict stays
/// unchanged.
void examine(Diagnosis& diagnosis, const DiagnosisOptions& options);

/// Returns the verdict as one sentence for a technician.
[[nodiscard]] std::string verdict_sentence(const Diagnosis& diagnosis);

}  // namespace softgrip::sysid
