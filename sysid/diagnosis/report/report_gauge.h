#pragma once
// The section of the report about a gauge check.

#include "sysid/diagnosis/gauge/gauge_verdict.h"
#include "sysid/pages/chart.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// Readings and hypotheses beside the straight line that fits the readings best, over the gauge's position.
[[nodiscard]] Chart gauge_chart(const GaugeEvidence& gauge);

/// The section of the page.
void add_gauge_section(Page& page, const GaugeEvidence& gauge);

}  // namespace softgrip::sysid
