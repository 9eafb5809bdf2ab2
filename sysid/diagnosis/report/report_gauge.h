#pragma once
// The section of the report about a gauge check.

#include "sysid/diagnosis/gauge/gauge_verdict.h"
#include "sysid/pages/chart.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// Returns readings and hypotheses relative to the straight line that fits the readings best, over the gauge
/// position.
[[nodiscard]] Chart gauge_chart(const GaugeEvidence& gauge);

/// Adds the section to the page.
void add_gauge_section(Page& page, const GaugeEvidence& gauge);

}  // namespace softgrip::sysid
