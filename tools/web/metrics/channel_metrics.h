#pragma once
// Writes the Prometheus metrics of each finger.

#include <nlohmann/json_fwd.hpp>

#include "tools/web/metrics/metric_text.h"

namespace softgrip::web {

/// Writes the metrics of each finger. `channels` is the list in a status of the socket API.
void tell_channels(const nlohmann::ordered_json& channels, MetricText& metrics);

}  // namespace softgrip::web
