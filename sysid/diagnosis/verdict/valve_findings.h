#pragma once
// What the valve does between the command and the measured pressure, judged by the measured pressure: where
// the pressure is recorded, a cause in the valve is no guess from the finger's motion.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/verdict/named_cause.h"
#include "sysid/logs/log.h"
#include "sysid/structure/valve_stage.h"

namespace softgrip::sysid {

struct ValveFindings {
  /// At full inclusion and, but for a leak, which a scale may pass for, without rivals; none where the stage
  /// is far off, and none that the given model has. Their gains are of the measured pressure (gain_kpa2,
  /// heldout_gain_percent), and gain_mm2 is 0.
  std::vector<NamedCause> named;
  std::string advice;  ///< what tells a leak that is named from a scale; empty: none is
  ValveStage stage;    ///< dead time, lag and what is named
  double heldout_rmse_kpa = 0;
  double noise_kpa = 0;  ///< of the measured pressure, sample to sample
};

struct ValveQuestion {
  const model::Model& given;
  bool held = false;
  double noise_mm = 0;  ///< of the finger's readings: what moves it by less is not named
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< 0: as many as there are cores
};

/// Nothing where a log has no measured pressure.
[[nodiscard]] std::optional<ValveFindings> find_in_valve(const std::vector<Log>& logs,
                                                         const ValveQuestion& question);

}  // namespace softgrip::sysid
