#pragma once
// Writes the diagnosis as an HTML page. The first sentence is for technicians, the rest for readers who check
// the result.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/logs/log.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// An experiment that separates causes which the logs cannot separate.
struct ProposedExperiment {
  std::string file;                    ///< file name in the folder of the report
  std::vector<std::string> separates;  ///< ids of causes
  double predicted_separation_sigma = 0;
  double rig_minutes = 0;
  std::string waveform;  ///< description of the waveform
};

/// Simulated tracking of a reference trajectory with each model as the feedforward.
struct ClosedLoopCurves {
  struct Scheme {
    std::string name;  ///< "PID alone", "recalibrated model", "extended model"; it determines the line style
    double rmse_mm = 0;
    std::vector<double> displacement_mm;  ///< displacement at each time of `time_s`
  };
  std::string reference;  ///< description of the reference trajectory
  std::vector<double> time_s;
  std::vector<double> reference_mm;
  std::vector<Scheme> schemes;  ///< at most three schemes, the best last
  std::vector<std::string> notes;
  model::OutputUnit output_unit = model::OutputUnit::mm;
};

/// Data for the page.
struct DiagnosisReport {
  const Diagnosis& result;
  const std::vector<Log>& logs;
  const model::Model& given;
  std::uint64_t seed = 1;
  std::optional<ProposedExperiment> next_experiment;
  std::vector<std::string> advice;  ///< further measurements that would help, one sentence each
  std::optional<ClosedLoopCurves> closed_loop;
};

/// Returns the page for report.html.
[[nodiscard]] Page diagnosis_page(const DiagnosisReport& report);

}  // namespace softgrip::sysid
