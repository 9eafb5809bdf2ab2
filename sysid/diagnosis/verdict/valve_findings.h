#pragma once
// Finds causes between the command and the measured pressure. If the pressure was recorded, valve causes are
// determined from the pressure instead of the motion of the finger.

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
  /// Causes between the command and the measured pressure. The list is empty if the fit of the valve model is
  /// bad. Causes that the given model contains are omitted. Every cause has an inclusion of 1 and no
  /// alternatives, except a leak, which may be a scale error. The error reductions refer to the measured
  /// pressure (gain_kpa2, heldout_gain_percent), and gain_mm2 is 0.
  std::vector<NamedCause> named;
  std::string advice;  ///< advice that separates a named leak from a scale error; empty if no leak is named
  ValveStage stage;    ///< fitted valve model: dead time, lag and the named causes
  double heldout_rmse_kpa = 0;
  double noise_kpa = 0;  ///< noise of the measured pressure, estimated from consecutive samples
};

struct ValveQuestion {
  const model::Model& given;
  bool held = false;
  double noise_mm = 0;  ///< noise of the displacement readings; a cause with a smaller effect is not named
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< number of threads; 0: one per core
};

/// Searches for causes between the command and the measured pressure. Returns nullopt if a log contains no
/// measured pressure.
[[nodiscard]] std::optional<ValveFindings> find_in_valve(const std::vector<Log>& logs,
                                                         const ValveQuestion& question);

}  // namespace softgrip::sysid
