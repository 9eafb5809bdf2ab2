#pragma once
// How a diagnosis was reached: the errors of the models, on what they depend, why what was named was named,
// and what the data cannot tell.

#include "sysid/diagnosis/report/report.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

void add_reached(Page& page, const DiagnosisReport& report);

}  // namespace softgrip::sysid
