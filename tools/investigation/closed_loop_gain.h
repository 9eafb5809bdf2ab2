#pragma once
// Computes the benefit of an extended model in closed loop. A simulated rig tracks the same reference with
// the refitted and with the extended model in the feedforward. The gains of both come from the same search.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "control/elements/feedforward.h"
#include "control/elements/pid.h"
#include "control/feedforward/invertible_part.h"
#include "control/tuning/tracking_run.h"
#include "model/model.h"

namespace softgrip::tools {

/// Input of the comparison.
struct ClosedLoopQuestion {
  model::Model recalibrated;
  model::Model extended;  ///< also the simulated rig, with other parameters within `rig_scatter`
  double noise_mm = 0.03;
  double span_mm = 0;  ///< span of the logs: the reference is scaled down if 13 ± 7 mm is too large for it
  double pressure_max_kpa = 60;
  double frequency_hz = 0.2;
  double rig_scatter = 0.02;  ///< relative error of the rig's parameters, because no model is exact
  std::uint64_t seed = 1;
};

/// The result of one controller on the simulated rigs.
struct ClosedLoopScheme {
  double rmse_mm = 0;  ///< median over the rigs
  control::PidSettings pid;
  /// full_model if the model has a causal inverse. Otherwise planned, or full_model of the invertible part;
  /// the one with the smaller error counts. If neither is better than the PID alone, none: the numbers are
  /// then those of the PID.
  control::FeedforwardKind feedforward = control::FeedforwardKind::none;
  std::string refused;  ///< reason if the feedforward is not full_model of the whole model
  std::optional<control::InvertiblePart> part;  ///< the part that is inverted, if it is not the whole model
  control::TrackingTrace trace;                 ///< on the rig with the median error
};

struct ClosedLoopGain {
  ClosedLoopScheme pid_alone;
  ClosedLoopScheme recalibrated;
  ClosedLoopScheme extended;
  double mean_mm = 13;
  double amplitude_mm = 7;
  model::OutputUnit output_unit = model::OutputUnit::mm;
  double frequency_hz = 0.2;
  double rig_scatter = 0;
  int rigs = 0;
  double wall_s = 0;

  [[nodiscard]] std::string reference() const;           ///< "13 ± 7 mm at 0.2 Hz"
  [[nodiscard]] std::vector<std::string> notes() const;  ///< remarks on the numbers
};

[[nodiscard]] ClosedLoopGain measure_closed_loop(const ClosedLoopQuestion& question);

/// Adds "closed_loop" to a diagnosis.json or investigation.json.
void add_closed_loop(nlohmann::ordered_json& json, const ClosedLoopGain& gain);

}  // namespace softgrip::tools
