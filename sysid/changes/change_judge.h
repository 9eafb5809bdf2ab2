#pragma once
// Finds the causes of a change in one quantity, the displacement or the pressure.

#include <vector>

#include "sysid/changes/base.h"
#include "sysid/changes/change.h"

namespace softgrip::sysid {

/// Finds the causes of a change in the later records. Adds the causes, the result for this quantity and
/// warnings to the diagnosis.
/// @param base  baseline model, fitted to the healthy records.
/// @param pressure_is_judged  true: the diagnosis evaluates the pressure separately, so the evaluation of the
/// displacement does not include the valve.
void judge_change(Base base, bool pressure_is_judged, const std::vector<Record>& later,
                  const ChangeOptions& options, ChangeDiagnosis& diagnosis);

}  // namespace softgrip::sysid
