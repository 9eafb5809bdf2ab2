#pragma once
// Handles causes that a simulation of the logs cannot detect: causes whose condition does not occur in the
// logs, and causes in a closed loop.

#include "sysid/diagnosis/verdict/diagnosis.h"

namespace softgrip::sysid {

/// Corrects the causes that a search has named. A drift of the sensor is only visible while the finger rests
/// without pressure. If no log contains such a rest, the drift is moved from `causes` to `partial` and listed
/// in `not_tested`. If every log is a closed loop, a warning is added. If the phase of each loop is that of a
/// sticking valve (sysid/evidence/loop_phase.h), valve_deadband is named and the causes of the search are
/// moved to `partial`.
void correct_by_logs(Diagnosis& diagnosis, const std::vector<Log>& logs);

}  // namespace softgrip::sysid
