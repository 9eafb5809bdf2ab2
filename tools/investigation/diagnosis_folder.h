#pragma once
// Writes the files of a diagnosis: diagnosis.json, model.yaml, next_experiment.yaml, gauge_positions.csv.

#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "sysid/diagnosis/experiments/experiment.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "tools/investigation/closed_loop_gain.h"

namespace softgrip::tools {

/// The next experiment and the closed-loop comparison that follow from a diagnosis.
struct Consequences {
  sysid::NextExperiment experiment;
  std::optional<ClosedLoopGain> closed_loop;  ///< benefit of the extended model in closed loop; nullopt: not
                                              ///< requested, or the diagnosis found no extension
};

struct ConsequenceOptions {
  sysid::ExperimentOptions experiment;
  bool closed_loop = true;
  std::uint64_t seed = 1;
};

[[nodiscard]] Consequences consequences_of(const sysid::Diagnosis& diagnosis,
                                           const ConsequenceOptions& options);

/// The model, the logs and the options of a diagnosis.
struct DiagnosisSource {
  const std::vector<sysid::Log>& logs;
  const model::Model& given;
  std::vector<std::string> call;  ///< command line that started the diagnosis; empty: no command started it
};

/// Removes the files of an earlier write_diagnosis_folder() that do not belong to a diagnosis of a change. If
/// the folder has no diagnosis.json, its files belong to the user, and none is removed.
void remove_results_of_a_model(const std::string& folder);
/// Returns the names of the files that write_diagnosis_folder() may replace or remove. It never replaces an
/// existing gauge_positions.csv, so this file is not in the list.
[[nodiscard]] std::vector<std::string> diagnosis_files();

/// Writes the files into `folder` and returns the text of diagnosis.json. If this diagnosis has no
/// next_experiment.yaml or no feedforward_model.yaml, removes the file of this name from an earlier
/// diagnosis.
/// @param channel  channel for which the experiment is written; "": all channels of the rig.
[[nodiscard]] tl::expected<std::string, std::string> write_diagnosis_folder(const std::string& folder,
                                                                            const sysid::Diagnosis& diagnosis,
                                                                            const DiagnosisSource& source,
                                                                            const Consequences& consequences,
                                                                            const std::string& channel = "");

/// Returns the models, logs and settings for the closed-loop comparison of a diagnosis.
[[nodiscard]] ClosedLoopQuestion closed_loop_question(const sysid::Diagnosis& diagnosis, std::uint64_t seed);

/// Returns sentences about the next experiment and the closed loop, one per line.
[[nodiscard]] std::string text_of(const Consequences& consequences, const std::string& folder);

}  // namespace softgrip::tools
