#pragma once
// Handles causes that a simulation of the logs cannot detect. Either the logs do not contain the condition in
// which the cause has an effect, or the logs were recorded in a closed loop.

#include "sysid/diagnosis/verdict/diagnosis.h"

namespace softgrip::sysid {

/// Corrects the causes that a search has named. A drift of the sensor is visible only while the finger rests
/// without pressure. If no log contains such a rest, the drift is moved from `causes` to `partial` and listed
/// in `not_tested`. If every log was recorded in a closed loop, a warning is added. If the phase of each loop
/// is that of a sticking valve (sysid/evidence/loop_phase.h), valve_deadband is named, and the causes of the
/// search are moved to `partial`.
void correct_by_logs(Diagnosis& diagnosis, const std::vector<Log>& logs);

}  // namespace softgrip::sysid
