#pragma once
// Prometheus metrics of events.

#include <nlohmann/json_fwd.hpp>

#include "tools/web/metrics/metric_text.h"

namespace softgrip::web {

/// `events` belongs to the statistics of the socket API, `channels` to its status. Each result of each finger
/// has a sample from the start, because Prometheus sees no increase when a sample first appears.
void tell_events(const nlohmann::ordered_json& events, const nlohmann::ordered_json& channels,
                 MetricText& metrics);

}  // namespace softgrip::web
