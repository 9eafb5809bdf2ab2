#pragma once
// Writes the section of the report about the valve, which requires a measured pressure.

#include "sysid/diagnosis/verdict/valve_findings.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// Adds the section to the page.
void add_valve_section(Page& page, const ValveFindings& in_valve);

}  // namespace softgrip::sysid
