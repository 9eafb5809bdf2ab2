#pragma once
// What a diagnosis leaves behind: diagnosis.json, model.yaml, next_experiment.yaml, gauge_positions.csv.

#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "sysid/diagnosis/experiments/experiment.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "tools/investigation/closed_loop_gain.h"

namespace softgrip::tools {

/// What follows from a diagnosis.
struct Consequences {
  sysid::NextExperiment experiment;
  std::optional<ClosedLoopGain> closed_loop;  ///< empty: not wanted, or there is no extension
};

struct ConsequenceOptions {
  sysid::ExperimentOptions experiment;
  bool closed_loop = true;
  std::uint64_t seed = 1;
};

[[nodiscard]] Consequences consequences_of(const sysid::Diagnosis& diagnosis,
                                           const ConsequenceOptions& options);

/// What a diagnosis was made of.
struct DiagnosisSource {
  const std::vector<sysid::Log>& logs;
  const model::Model& given;
  std::vector<std::string> call;  ///< the command and what it was given; empty: by no command of its own
};

/// Names of the files that write_diagnosis_folder() writes, replaces or removes.
[[nodiscard]] std::vector<std::string> diagnosis_files();

/// Writes the files into `folder` and returns what diagnosis.json says; a next_experiment.yaml or a
/// feedforward_model.yaml of an earlier diagnosis goes where there is none.
/// @param channel  for which the experiment is written; "": all of the rig.
[[nodiscard]] tl::expected<std::string, std::string> write_diagnosis_folder(const std::string& folder,
                                                                            const sysid::Diagnosis& diagnosis,
                                                                            const DiagnosisSource& source,
                                                                            const Consequences& consequences,
                                                                            const std::string& channel = "");

/// The question of the closed loop that a diagnosis answers.
[[nodiscard]] ClosedLoopQuestion closed_loop_question(const sysid::Diagnosis& diagnosis, std::uint64_t seed);

/// Sentences about the consequences, for people; one per line.
[[nodiscard]] std::string text_of(const Consequences& consequences, const std::string& folder);

}  // namespace softgrip::tools
