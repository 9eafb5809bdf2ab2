#pragma once
// Writes the appendix of a report for readers who check the diagnosis: further logs, candidates, conditions,
// equations, parameters and hashes.

#include "sysid/diagnosis/report/report.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

void add_appendix(Page& page, const DiagnosisReport& report);

}  // namespace softgrip::sysid
