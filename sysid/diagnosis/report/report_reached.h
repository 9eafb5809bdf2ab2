#pragma once
// Writes method and evidence of a diagnosis: the errors of the models, the conditions on which these errors
// depend, the reasons for the named causes, and the limitations of the data.

#include "sysid/diagnosis/report/report.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

void add_reached(Page& page, const DiagnosisReport& report);

}  // namespace softgrip::sysid
