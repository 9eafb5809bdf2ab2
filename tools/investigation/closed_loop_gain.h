#pragma once
// What an extension is worth in closed loop: the same reference tracked on a simulated rig with the
// recalibrated and with the extended model in the feedforward, gains from the same search for each.

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

/// The question.
struct ClosedLoopQuestion {
  model::Model recalibrated;
  model::Model extended;  ///< also the rig, with other parameters within `rig_scatter`
  double noise_mm = 0.03;
  double span_mm = 0;  ///< of the logs: the reference is scaled to it where 13 ± 7 mm is too much
  double pressure_max_kpa = 60;
  double frequency_hz = 0.2;
  double rig_scatter = 0.02;  ///< no model is exact: the rig's parameters differ from the extended model's
  std::uint64_t seed = 1;
};

/// One controller on that rig.
struct ClosedLoopScheme {
  double rmse_mm = 0;  ///< median over rigs
  control::PidSettings pid;
  /// full_model; where the model cannot be undone tick by tick, planned, or full_model of what of it can be
  /// undone, whichever tracks better; where neither serves better than the PID alone, none: then the numbers
  /// are the PID's.
  control::FeedforwardKind feedforward = control::FeedforwardKind::none;
  std::string refused;                          ///< why it is not full_model, or not of the whole model
  std::optional<control::InvertiblePart> part;  ///< what the feedforward is of, where not of the whole model
  control::TrackingTrace trace;                 ///< on the rig of that median
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
  [[nodiscard]] std::vector<std::string> notes() const;  ///< what must be known beside the numbers
};

[[nodiscard]] ClosedLoopGain measure_closed_loop(const ClosedLoopQuestion& question);

/// Fills in "closed_loop" of a diagnosis.json or investigation.json.
void add_closed_loop(nlohmann::ordered_json& json, const ClosedLoopGain& gain);

}  // namespace softgrip::tools
