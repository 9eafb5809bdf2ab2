#pragma once
// What Prometheus is told of the fingers' health: the last result of `softgrip health`.

#include <nlohmann/json_fwd.hpp>

#include "tools/web/metrics/metric_text.h"

namespace softgrip::web {

/// `health`: of health.json; null where there is none, then nothing is told.
void tell_health(const nlohmann::ordered_json& health, MetricText& metrics);

}  // namespace softgrip::web
