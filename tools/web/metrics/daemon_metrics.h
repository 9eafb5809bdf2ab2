#pragma once
// Writes the Prometheus metrics of the daemon. docs/reference/metrics.md lists them. Names and units are part
// of the public format.

#include <nlohmann/json_fwd.hpp>

#include "tools/web/metrics/metric_text.h"

namespace softgrip::web {

/// Writes the metrics of the daemon. `status` is a status of the socket API. If the daemon does not respond,
/// it is null, and only `softgrip_up` with the value 0 is written. `statistics` is the statistics object of
/// the socket API, or null if it has not been received.
void tell_daemon(const nlohmann::ordered_json& status, const nlohmann::ordered_json& statistics,
                 MetricText& metrics);

}  // namespace softgrip::web
