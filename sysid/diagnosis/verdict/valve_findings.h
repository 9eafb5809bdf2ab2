#pragma once
// Finds causes between the command and the measured pressure. If the pressure was recorded, valve causes are
// determined from the pressure and not from the motion of the finger.

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
  /// Causes between the command and the measured pressure. The list is empty if the valve model does not
  /// describe the measured pressure. Causes that the given model already contains are left out. A leak has a
  /// scale error as its alternative, and a dead time may have a lag as its alternative. The error reductions
  /// refer to the measured pressure (gain_kpa2, gain_percent); gain_mm2 is 0.
  std::vector<NamedCause> named;
  std::string advice;  ///< advice on how to separate a named leak from a scale error; empty: no leak is named
  ValveStage stage;    ///< fitted valve model: dead time, lag, and the parts for the named causes
  double heldout_rmse_kpa = 0;
  double noise_kpa = 0;  ///< noise of the measured pressure, estimated from consecutive samples
};

struct ValveQuestion {
  const model::Model& given;
  bool held = false;
  double noise_mm = 0;  ///< noise of the displacement readings; a cause is named only if its effect is larger
                        ///< than this noise
  std::uint64_t seed = 1;
  unsigned threads = 0;  ///< number of threads; 0: one per core
};

/// Searches for causes between the command and the measured pressure. Returns nullopt if a log contains no
/// measured pressure, or if the pressure is constant.
[[nodiscard]] std::optional<ValveFindings> find_in_valve(const std::vector<Log>& logs,
                                                         const ValveQuestion& question);

}  // namespace softgrip::sysid
