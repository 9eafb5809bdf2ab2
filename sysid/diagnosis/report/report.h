#pragma once
// The diagnosis as a page: for a technician its first sentence, for a referee the rest.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// An experiment that separates what the logs could not, as the report shows it.
struct ProposedExperiment {
  std::string file;                    ///< beside the report
  std::vector<std::string> separates;  ///< ids of causes
  double predicted_separation_sigma = 0;
  double rig_minutes = 0;
  std::string waveform;  ///< in words
};

/// What goes onto the page.
struct DiagnosisReport {
  const Diagnosis& result;
  const std::vector<Log>& logs;
  const model::Model& given;
  std::uint64_t seed = 1;
  std::optional<ProposedExperiment> next_experiment;
  std::vector<std::string> advice;  ///< what would tell more besides; sentences
};

/// A self-contained page below 1.5 MB.
[[nodiscard]] std::string diagnosis_html(const DiagnosisReport& report);

}  // namespace softgrip::sysid
