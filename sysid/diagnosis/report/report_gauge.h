#pragma once
// Writes the section of the report about a gauge check.

#include "sysid/diagnosis/gauge/gauge_verdict.h"
#include "sysid/pages/chart.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// Returns a chart of the readings and the predictions of the hypotheses over the gauge position. The
/// straight line that fits the readings best is subtracted from the readings and from the predictions.
[[nodiscard]] Chart gauge_chart(const GaugeEvidence& gauge);

/// Adds the section about the gauge check to the page.
void add_gauge_section(Page& page, const GaugeEvidence& gauge);

}  // namespace softgrip::sysid
