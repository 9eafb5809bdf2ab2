#pragma once
// What the report shows of a gauge check.

#include "sysid/chart.h"
#include "sysid/diagnosis/gauge_verdict.h"
#include "sysid/page.h"

namespace softgrip::sysid {

/// Readings and hypotheses beside the straight line that fits the readings best, over the gauge's position.
[[nodiscard]] Chart gauge_chart(const GaugeEvidence& gauge);

/// The section of the page.
void add_gauge_section(Page& page, const GaugeEvidence& gauge);

}  // namespace softgrip::sysid
