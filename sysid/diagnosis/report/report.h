#pragma once
// Writes a diagnosis as an HTML page. Its first sentence is for technicians, and the rest is for readers who
// check the result.
// Writes diagnosis.json in the documented format.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "model/model.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/logs/log.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// An experiment that separates causes that the logs cannot separate.
struct ProposedExperiment {
  std::string file;                    ///< name of the sequence file in the folder of the report
  std::vector<std::string> separates;  ///< ids of the causes that the experiment separates
  double predicted_separation_sigma = 0;
  double rig_minutes = 0;
  std::string waveform;  ///< description of the waveform
};

/// Simulated tracking of a reference trajectory. The feedforward of each scheme uses a different model.
struct ClosedLoopCurves {
  struct Scheme {
    /// "PID alone", "recalibrated model" or "extended model"; the name determines the line style.
    std::string name;
    double rmse_mm = 0;
    std::vector<double> displacement_mm;  ///< displacement at the times in `time_s`
  };
  std::string reference;  ///< description of the reference trajectory
  std::vector<double> time_s;
  std::vector<double> reference_mm;
  std::vector<Scheme> schemes;  ///< at most three schemes; the best one comes last
  std::vector<std::string> notes;
  model::OutputUnit output_unit = model::OutputUnit::mm;
};

/// Data that the report page shows.
struct DiagnosisReport {
  const Diagnosis& result;
  const std::vector<Log>& logs;
  const model::Model& given;
  std::uint64_t seed = 1;
  std::optional<ProposedExperiment> next_experiment;
  std::vector<std::string> advice;  ///< proposed measurements, one sentence each
  std::optional<ClosedLoopCurves> closed_loop;
};

/// Returns the page for report.html.
[[nodiscard]] Page diagnosis_page(const DiagnosisReport& report);

/// Returns the content of diagnosis.json. `next_experiment` is null until add_experiment() replaces it.
[[nodiscard]] nlohmann::ordered_json json_of(const Diagnosis& diagnosis);

}  // namespace softgrip::sysid
