#pragma once
// Writes a diagnosis as an HTML page. The first sentence of the page is for technicians. The rest of the page
// is for readers who check the result.
// Converts a diagnosis to the content of diagnosis.json. docs/reference documents the keys.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/result/result.h"
#include "model/model.h"
#include "sysid/diagnosis/experiments/experiment.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/logs/log.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// Simulated tracking of a reference trajectory with several control schemes. Each scheme uses a different
/// model for its feedforward, or no model.
struct ClosedLoopCurves {
  struct Scheme {
    /// "PID alone", "recalibrated model" or "extended model". The name determines the line style in the
    /// figure.
    std::string name;
    double rmse_mm = 0;
    std::vector<double> displacement_mm;  ///< displacement at the times in `time_s`
  };
  std::string reference;  ///< description of the reference trajectory
  std::vector<double> time_s;
  std::vector<double> reference_mm;
  std::vector<Scheme> schemes;  ///< at most three schemes; the scheme with the best model comes last
  std::vector<std::string> notes;
  model::OutputUnit output_unit = model::OutputUnit::mm;
};

/// Data that the report page shows.
struct DiagnosisReport {
  const Diagnosis& result;
  const std::vector<Log>& logs;
  const model::Model& given;
  std::uint64_t seed = 1;
  NextExperiment experiment;  ///< proposal for the next measurements; empty: none is proposed
  std::optional<ClosedLoopCurves> closed_loop;
};

/// Returns the report as an HTML page.
[[nodiscard]] Page diagnosis_page(const DiagnosisReport& report);

/// Returns the content of diagnosis.json. The key `next_experiment` is null. The fields of a NextExperiment
/// replace it if they follow these fields. Fields with a title are shown in the summary: the errors of the
/// models.
[[nodiscard]] result::Fields fields_of(const Diagnosis& diagnosis);

}  // namespace softgrip::sysid
