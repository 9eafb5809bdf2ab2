#pragma once
// The next experiment: the waveform of the menu on which rivals that explain the data alike would differ
// most, after each rival had every chance to explain what the other predicts.

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "sysid/diagnosis/experiments/waveform.h"
#include "sysid/diagnosis/verdict/diagnosis.h"

namespace softgrip::sysid {

struct ExperimentOptions {
  /// Not set: the largest pressure of the logs, 300 kPa/s.
  std::optional<RigLimits> limits;
  /// Also where the verdict has no rivals: then against the next best candidates.
  bool always = false;
  /// The rig can record the valve's pressure, but the logs do not have it (for advice).
  bool pressure_recorded = false;
  double most_minutes = 10;
  /// Menu entries that were run already: not proposed again.
  std::vector<std::string> done;
  unsigned threads = 0;
};

/// How far two structures would be apart.
struct Separation {
  std::string one;
  std::string other;
  /// Root of the sum of squares of what remains between them, in standard deviations of the noise, as
  /// correlated as the noise was found: the smaller one of `one` being true and `other` refitted and of the
  /// reverse.
  double sigma = 0;
};

/// One entry of the menu, judged.
struct JudgedWaveform {
  Waveform waveform;
  double minutes = 0;  ///< with the rest before it
  std::vector<Separation> separations;
  double merit = 0;  ///< what is learnt per minute
};

/// The sensor against known positions: for rivals that no waveform tells apart and that make other sensors.
struct ProposedGaugeCheck {
  std::vector<double> positions_mm;    ///< in the order in which they are read
  std::vector<std::string> separates;  ///< ids of causes
  double minutes = 0;
};

/// What to do next.
struct NextExperiment {
  std::optional<JudgedWaveform> best;
  std::vector<std::string> separates;             ///< ids that `best` tells apart
  double predicted_separation_sigma = 0;          ///< the smallest among the pairs that it tells apart
  std::vector<JudgedWaveform> menu;               ///< all that was judged
  std::optional<ProposedGaugeCheck> gauge_check;  ///< empty where it helps nobody or was made already
  /// What no waveform can do: a column to be recorded, a load to be changed. Sentences.
  std::vector<std::string> advice;
};

/// Beside diagnosis.json, where a gauge check is proposed: a gauge file that waits for its readings.
inline constexpr const char* gauge_positions_file = "gauge_positions.csv";

/// Pairs nearer than this are not told apart.
inline constexpr double separation_needed_sigma = 5;

/// Empty where the verdict asks for none.
[[nodiscard]] NextExperiment design_experiment(const Diagnosis& diagnosis, const ExperimentOptions& options);

/// A sequence file of one pressure step, as softgripd reads it. @param channel  "" for all of the rig.
[[nodiscard]] std::string sequence_yaml(const NextExperiment& experiment, const std::string& channel = "");
/// The same of any entry of the menu.
[[nodiscard]] std::string sequence_yaml(const Waveform& waveform, const std::string& channel);

/// Fills in next_experiment and gauge_check (null without one) and experiment_advice of a diagnosis.json.
void add_experiment(nlohmann::ordered_json& diagnosis_json, const NextExperiment& experiment,
                    const std::string& file);

}  // namespace softgrip::sysid
