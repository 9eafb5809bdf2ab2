#pragma once
// Prometheus metrics of the daemon. docs/reference/metrics.md lists them. Names and units are part of the
// public format.

#include <nlohmann/json_fwd.hpp>

#include "tools/web/metrics/metric_text.h"

namespace softgrip::web {

/// Writes the metrics of the daemon. `status` is a status of the socket API, or null if the daemon does not
/// respond. If it is null, only `softgrip_up` is written, with the value 0. `statistics` are those of the
/// socket API, or null if they are not known yet.
void tell_daemon(const nlohmann::ordered_json& status, const nlohmann::ordered_json& statistics,
                 MetricText& metrics);

}  // namespace softgrip::web
