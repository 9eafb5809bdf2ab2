#pragma once
// Writes the section of the report about a gauge check.

#include "sysid/diagnosis/gauge/gauge_verdict.h"
#include "sysid/pages/chart.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// Returns a chart of readings and hypotheses over the gauge position. Both are drawn relative to the
/// straight line that fits the readings best.
[[nodiscard]] Chart gauge_chart(const GaugeEvidence& gauge);

/// Adds the section to the page.
void add_gauge_section(Page& page, const GaugeEvidence& gauge);

}  // namespace softgrip::sysid
