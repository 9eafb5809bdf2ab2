#pragma once
// Designs the next experiment. It selects the waveform of the menu on which alternatives that explain the
// data equally well differ most. Each alternative is first refitted to the prediction of the other.

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
  /// Also design an experiment if the verdict has no alternatives, against the next best candidates.
  bool always = false;
  /// The rig can record the valve's pressure, but the logs do not have it (for advice).
  bool pressure_recorded = false;
  double most_minutes = 10;
  /// Menu entries that were already played; they are not proposed again.
  std::vector<std::string> done;
  unsigned threads = 0;
};

/// Predicted distance between two structures.
struct Separation {
  std::string one;
  std::string other;
  /// Root of the sum of squares of the remaining difference, in standard deviations of the noise. The noise
  /// has its estimated correlation. The value is the smaller of two cases: `one` is true and `other` is
  /// refitted, or the reverse.
  double sigma = 0;
};

/// One evaluated entry of the menu.
struct JudgedWaveform {
  Waveform waveform;
  double minutes = 0;  ///< duration including the rest before it
  std::vector<Separation> separations;
  double merit = 0;  ///< information per minute
};

/// A check of the sensor at known positions. It separates alternatives with different sensor shapes if no
/// waveform can.
struct ProposedGaugeCheck {
  std::vector<double> positions_mm;                       ///< positions in the order of reading
  model::OutputUnit output_unit = model::OutputUnit::mm;  ///< unit of the positions
  std::vector<std::string> separates;                     ///< ids of causes
  double minutes = 0;
};

/// The proposed next experiment.
struct NextExperiment {
  std::optional<JudgedWaveform> best;
  std::vector<std::string> separates;             ///< ids that `best` separates
  double predicted_separation_sigma = 0;          ///< smallest separation among the pairs that it separates
  std::vector<JudgedWaveform> menu;               ///< all evaluated entries
  std::optional<ProposedGaugeCheck> gauge_check;  ///< empty if it separates no causes or was already made
  /// Actions that no waveform can replace: a column to record, a load to change. Full sentences.
  std::vector<std::string> advice;
};

/// Name of an empty gauge file next to diagnosis.json, written if a gauge check is proposed.
inline constexpr const char* gauge_positions_file = "gauge_positions.csv";

/// Pairs with a smaller separation are indistinguishable.
inline constexpr double separation_needed_sigma = 5;

/// Returns an empty design if the verdict needs no experiment.
[[nodiscard]] NextExperiment design_experiment(const Diagnosis& diagnosis, const ExperimentOptions& options);

/// Returns a sequence file of one pressure step for softgripd. @param channel  empty: all channels of the
/// rig.
[[nodiscard]] std::string sequence_yaml(const NextExperiment& experiment, const std::string& channel = "");
/// Returns the sequence file of any entry of the menu.
[[nodiscard]] std::string sequence_yaml(const Waveform& waveform, const std::string& channel);

/// Adds next_experiment, gauge_check (null without one) and experiment_advice to a diagnosis.json.
void add_experiment(nlohmann::ordered_json& diagnosis_json, const NextExperiment& experiment,
                    const std::string& file);

}  // namespace softgrip::sysid
