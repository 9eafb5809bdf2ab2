#pragma once
// Writes the part of a report on the method and the evidence of the diagnosis: errors of the models,
// conditions on which these errors depend, reasons for the named causes, and limitations of the data.

#include "sysid/diagnosis/report/report.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

void add_reached(Page& page, const DiagnosisReport& report);

}  // namespace softgrip::sysid
