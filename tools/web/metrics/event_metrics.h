#pragma once
// Writes the Prometheus metrics of events.

#include <nlohmann/json_fwd.hpp>

#include "tools/web/metrics/metric_text.h"

namespace softgrip::web {

/// Writes the numbers of events. `events` is a member of the statistics of the socket API, `channels` a
/// member of its status. Every possible result of each finger has a sample even if it has not occurred,
/// because Prometheus cannot compute an increase from the first sample of a series.
void tell_events(const nlohmann::ordered_json& events, const nlohmann::ordered_json& channels,
                 MetricText& metrics);

}  // namespace softgrip::web
