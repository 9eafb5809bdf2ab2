#pragma once
// Finds the causes between the command and the measured pressure. If the pressure was recorded, valve causes
// are determined from it and not from the motion of the finger.

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
  /// Causes at full inclusion and without alternatives, except for a leak, which may be a scale error. The
  /// list is empty if the stage fits badly. Causes that the given model already contains are omitted. The
  /// error reductions apply to the measured pressure (gain_kpa2, heldout_gain_percent), and gain_mm2 is 0.
  std::vector<NamedCause> named;
  std::string advice;  ///< advice that separates a named leak from a scale error; empty if no leak is named
  ValveStage stage;    ///< dead time, lag and the named causes
  double heldout_rmse_kpa = 0;
  double noise_kpa = 0;  ///< sample-to-sample noise of the measured pressure
};

struct ValveQuestion {
  const model::Model& given;
  bool held = false;
  double noise_mm = 0;  ///< noise of the displacement readings; causes with a smaller effect are not named
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< 0: one per core
};

/// Searches for causes between command and measured pressure. Returns an empty value if a log has no measured
/// pressure.
[[nodiscard]] std::optional<ValveFindings> find_in_valve(const std::vector<Log>& logs,
                                                         const ValveQuestion& question);

}  // namespace softgrip::sysid
