#pragma once
// Computes the benefit of an extended model in closed loop. Simulated rigs track the same reference, once
// with the refitted and once with the extended model in the feedforward. The PID gains of both are tuned by
// the same search.

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
  model::Model extended;  ///< this model, with its parameters changed by up to `rig_scatter`, is also the
                          ///< simulated rig
  double noise_mm = 0.03;
  double span_mm = 0;  ///< span of the logs; the reference of 13 ± 7 mm is scaled down if the span is too
                       ///< small for it; 0: unknown
  double pressure_max_kpa = 60;
  double frequency_hz = 0.2;
  double rig_scatter = 0.02;  ///< largest relative deviation of a parameter of the simulated rig
  std::uint64_t seed = 1;
};

/// The result of one controller on the simulated rigs.
struct ClosedLoopScheme {
  double rmse_mm = 0;  ///< median of the RMSE over the simulated rigs
  control::PidSettings pid;
  /// full_model if the model has a causal inverse. Otherwise the better of two: planned, or full_model of the
  /// invertible part. If neither has a smaller error than the PID alone, the value is none, and all numbers
  /// are those of the PID alone.
  control::FeedforwardKind feedforward = control::FeedforwardKind::none;
  std::string refused;  ///< reason why the feedforward is not full_model of the whole model; empty: it is
  std::optional<control::InvertiblePart> part;  ///< the part that is inverted, if it is not the whole model
  control::TrackingTrace trace;                 ///< trace on the rig with the median error
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
  [[nodiscard]] std::vector<std::string> notes() const;  ///< remarks on the conditions of the comparison
};

[[nodiscard]] ClosedLoopGain measure_closed_loop(const ClosedLoopQuestion& question);

/// Adds "closed_loop" to a diagnosis.json or investigation.json.
void add_closed_loop(nlohmann::ordered_json& json, const ClosedLoopGain& gain);

}  // namespace softgrip::tools
