#pragma once
// What the logs of a diagnosis cannot show by a simulation: causes whose condition they never meet, and
// closed loops.

#include "sysid/diagnosis/verdict/diagnosis.h"

namespace softgrip::sysid {

/// Corrects what a search has named.
/// - A drift of the sensor shows itself at rest without pressure. If no log holds such a rest, it is not
/// named: an error
///   that changes slowly is then of unknown origin. It is moved to `partial` and to `not_tested`.
/// - In a closed loop the command contains the noise of the readings. If the phase of each such loop says
/// that the valve
///   sticks (sysid/evidence/loop_phase.h), valve_deadband is named, and the causes of the search are moved to
///   `partial`.
void correct_by_logs(Diagnosis& diagnosis, const std::vector<Log>& logs);

}  // namespace softgrip::sysid
