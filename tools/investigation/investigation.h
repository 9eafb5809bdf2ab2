#pragma once
// Repeats diagnosis and experiment until one cause remains, the time budget is spent, or no experiment
// separates the alternatives. Formats the investigation as an HTML page.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "base/result/result.h"
#include "model/model.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/identification/validate.h"
#include "sysid/logs/log.h"
#include "tools/investigation/diagnosis_folder.h"

namespace softgrip::tools {

/// The reason why an experiment produced no log.
struct NotPlayed {
  bool stopped = false;  ///< true: the user has refused consent or pressed Ctrl-C
  std::string why;       ///< reason why the experiment produced no log, as a sentence
  /// Exit code of the command. not_acceptable: the experiment did not end as planned, for example because of
  /// a fault, and the outputs are safe. io: the board cannot be reached, another program uses the board, or
  /// the board did not confirm the safe outputs. daemon::exit_code_of() states the other codes.
  ExitCode code = ExitCode::failed;
};

/// Function that plays one experiment on a rig. `folder` exists and receives the recordings.
using Player = std::function<tl::expected<sysid::Log, NotPlayed>(const sysid::NextExperiment& experiment,
                                                                 const std::string& folder)>;

/// Function that moves the sensor's target to known positions and reads the sensor. `folder` exists and
/// receives the gauge file.
using GaugeTaker = std::function<tl::expected<sysid::GaugeFile, NotPlayed>(
    const std::vector<double>& positions_mm, const std::string& folder)>;

struct InvestigationOptions {
  model::Model given;
  std::vector<sysid::Log> logs;
  sysid::DiagnosisOptions diagnosis;
  sysid::ExperimentOptions experiment;  ///< settings of the search for the next experiment, with the limits
                                        ///< of the rig
  double budget_minutes = 30;           ///< longest permitted time of all experiments on the rig [min]
  std::string out;                      ///< folder in which the folders step_1, step_2, ... are created
  std::string channel;                  ///< channel on which the experiments are played; "": all channels of
                                        ///< the rig
  Player play;
  GaugeTaker take_gauge;  ///< function that checks the sensor; empty: neither a person nor a program can move
                          ///< the sensor's target
  std::function<void(const std::string&)> tell;  ///< function that prints one line of progress
};

enum class InvestigationEnd {
  settled,       ///< one cause per effect remains, or the model has no error that needs a cause
  unexplained,   ///< an error remains that no cause in the library explains, so no experiment would help
  nothing_left,  ///< no experiment separates the alternatives
  budget_spent,  ///< an experiment would separate the alternatives, but needs more time than the budget has
                 ///< left
  contact,       ///< the finger touched an object during an experiment
  not_as_asked,  ///< the rig did not play the requested experiment, because its command differs from the
                 ///< request
  stopped,       ///< the user stopped the investigation
  failed,        ///< an experiment could not be played, or its log could not be read
};
/// Returns the name of an end in JSON and on the screen, for example "settled".
[[nodiscard]] std::string_view name_of(InvestigationEnd end) noexcept;

/// Name of a step that checks the sensor against a gauge and plays no waveform.
inline constexpr const char* gauge_check_name = "gauge_check";

/// One diagnosis, and the experiment or gauge check that follows this diagnosis.
struct InvestigationStep {
  std::string folder;  ///< name of the folder of this step, inside the output folder
  sysid::Verdict verdict = sysid::Verdict::unexplained;
  std::string sentence;             ///< verdict of the diagnosis as text
  double recalibrated_rmse_mm = 0;  ///< held-out RMSE of the refitted model [mm]
  double extended_rmse_mm = 0;      ///< held-out RMSE of the extended model [mm]
  std::vector<std::string> causes;
  std::vector<std::vector<std::string>> alternatives;
  std::string experiment;  ///< name of the waveform that was played, or gauge_check; empty: no waveform and
                           ///< no gauge check
  double predicted_separation_sigma = 0;
  double minutes = 0;
  std::string log;  ///< path of the log or of the gauge file of this step
  /// Comparison of the rig's response with the prediction by the extended model of this step; nullopt: the
  /// step played no waveform.
  std::optional<sysid::Validation> answer;
};

struct Investigation {
  InvestigationEnd end = InvestigationEnd::failed;
  std::string why;                   ///< reason for the end as a sentence; empty if the end is `settled`
  ExitCode code = ExitCode::failed;  ///< exit code of the program; used if the end is `failed`
  std::vector<InvestigationStep> steps;
  double budget_minutes = 0;
  double spent_minutes = 0;
  std::vector<sysid::Log> logs;  ///< the logs that the user gave, followed by the logs of the experiments
  std::optional<sysid::GaugeFile> gauge;  ///< readings of the sensor against a gauge, from the user or from a
                                          ///< step
  sysid::Diagnosis last;
};

/// The reason why an investigation has no result. Exit code input_refused: the logs of the user cannot be
/// used. Exit code io: a file cannot be written.
struct NotInvestigated {
  ExitCode code = ExitCode::failed;
  std::string why;  ///< reason why there is no result, as a sentence
};

[[nodiscard]] tl::expected<Investigation, NotInvestigated> investigate(const InvestigationOptions& options);

/// Returns the fields of one step. The fields with a title are a row in the table of the page.
[[nodiscard]] result::Fields fields_of(const InvestigationStep& step);
/// Returns the content of investigation.json. `rig` is the path of the rig file, or the command that played
/// the experiments.
[[nodiscard]] result::Fields fields_of(const Investigation& investigation, const std::string& rig);

/// Returns the HTML page of an investigation.
/// @param rig          path of the rig file, or the command that plays the experiments
/// @param closed_loop  sentences about the closed loop; empty: no closed loop was simulated
[[nodiscard]] std::string investigation_html(const Investigation& investigation, const std::string& rig,
                                             const std::string& closed_loop);

}  // namespace softgrip::tools
