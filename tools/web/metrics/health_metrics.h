#pragma once
// Writes the Prometheus metrics of the fingers' health, from the last result of `softgrip health`.

#include <nlohmann/json_fwd.hpp>

#include "tools/web/metrics/metric_text.h"

namespace softgrip::web {

/// Writes the metrics of a health result. `health` is the content of health.json. If it is null, writes
/// nothing.
void tell_health(const nlohmann::ordered_json& health, MetricText& metrics);

}  // namespace softgrip::web
