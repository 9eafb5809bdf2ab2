#pragma once
// Writes the section of the report about the valve. This section requires a measured pressure.

#include "sysid/diagnosis/verdict/valve_findings.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// Adds the section about the valve to the page.
void add_valve_section(Page& page, const ValveFindings& in_valve);

}  // namespace softgrip::sysid
