#pragma once
// Writes the appendix for readers who check a diagnosis: further logs, candidates, conditions, equations,
// parameters and hashes.

#include "sysid/diagnosis/report/report.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

void add_appendix(Page& page, const DiagnosisReport& report);

}  // namespace softgrip::sysid
