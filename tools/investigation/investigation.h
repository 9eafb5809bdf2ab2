#pragma once
// The loop closed: diagnose, play the experiment that would tell more, diagnose again, until one cause
// stands, the budget is spent or nothing is left to gain.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>
#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "model/model.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/identification/validate.h"
#include "sysid/logs/log.h"
#include "tools/investigation/diagnosis_folder.h"

namespace softgrip::tools {

/// Why an experiment gave no log.
struct NotPlayed {
  bool stopped = false;  ///< by the user: consent refused, Ctrl-C
  std::string why;       ///< a sentence
  /// not_acceptable: the rig had a fault on the way, and its outputs are safe. io: the board is away or
  /// taken.
  ExitCode code = ExitCode::failed;
};

/// Plays one experiment on whatever there is. `folder` exists; what is recorded belongs into it.
using Player = std::function<tl::expected<sysid::Log, NotPlayed>(const sysid::NextExperiment& experiment,
                                                                 const std::string& folder)>;

/// Puts the sensor's target at known positions and reads. `folder` exists; the gauge file belongs into it.
using GaugeTaker = std::function<tl::expected<sysid::GaugeFile, NotPlayed>(
    const std::vector<double>& positions_mm, const std::string& folder)>;

struct InvestigationOptions {
  model::Model given;
  std::vector<sysid::Log> logs;
  sysid::DiagnosisOptions diagnosis;
  sysid::ExperimentOptions experiment;  ///< with the rig's limits
  double budget_minutes = 30;           ///< of the rig's time
  std::string out;                      ///< step_1/, step_2/ ... are made in it
  std::string channel;                  ///< "": all of the rig
  Player play;
  GaugeTaker take_gauge;                         ///< empty: nobody can put the target anywhere
  std::function<void(const std::string&)> tell;  ///< one line about what goes on
};

enum class InvestigationEnd {
  settled,       ///< one cause stands for each effect, or the model needs none
  unexplained,   ///< something is left that no cause explains: no waveform helps
  nothing_left,  ///< no experiment would tell the alternatives apart
  budget_spent,  ///< one would, but it takes longer than what is left
  contact,       ///< the finger touched something while an experiment was played
  not_as_asked,  ///< the rig did not play the experiment that it was asked for
  stopped,       ///< by the user
  failed,        ///< an experiment could not be played or its log not be read
};
[[nodiscard]] const char* name_of(InvestigationEnd end);

/// What a step is called that checks the sensor against a gauge instead of playing a waveform.
inline constexpr const char* gauge_check_name = "gauge_check";

/// One diagnosis and what was done about it.
struct InvestigationStep {
  std::string folder;  ///< within `out`
  sysid::Verdict verdict = sysid::Verdict::unexplained;
  std::string sentence;             ///< the verdict in words
  double recalibrated_rmse_mm = 0;  ///< held out
  double extended_rmse_mm = 0;      ///< held out
  std::vector<std::string> causes;
  std::vector<std::vector<std::string>> alternatives;
  std::string experiment;  ///< the waveform that was played, or gauge_check; empty: none
  double predicted_separation_sigma = 0;
  double minutes = 0;
  std::string log;  ///< where its log is
  /// What the rig answered, predicted by this step's extended model; empty: nothing, or a gauge check.
  std::optional<sysid::Validation> answer;
};

struct Investigation {
  InvestigationEnd end = InvestigationEnd::failed;
  std::string why;                   ///< a sentence where it did not settle
  ExitCode code = ExitCode::failed;  ///< of `failed`
  std::vector<InvestigationStep> steps;
  double budget_minutes = 0;
  double spent_minutes = 0;
  std::vector<sysid::Log> logs;           ///< the given ones and those that were added
  std::optional<sysid::GaugeFile> gauge;  ///< given or made
  sysid::Diagnosis last;
};

/// Why an investigation has no result: input_refused, the given logs cannot be judged; io, a file cannot be
/// written.
struct NotInvestigated {
  ExitCode code = ExitCode::failed;
  std::string why;  ///< a sentence
};

[[nodiscard]] tl::expected<Investigation, NotInvestigated> investigate(const InvestigationOptions& options);

/// investigation.json. `rig`: what the experiments were played on.
[[nodiscard]] nlohmann::ordered_json json_of(const Investigation& investigation, const std::string& rig);

}  // namespace softgrip::tools
