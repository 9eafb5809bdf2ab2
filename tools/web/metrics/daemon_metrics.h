#pragma once
// What Prometheus is told of the daemon. docs/reference/metrics.md lists it; names and units are a contract.

#include <nlohmann/json_fwd.hpp>

#include "tools/web/metrics/metric_text.h"

namespace softgrip::web {

/// `status`: of the socket API, null where no daemon answers; then only `softgrip_up` is told, as 0.
/// `statistics`: of the socket API, null where they are not known yet.
void tell_daemon(const nlohmann::ordered_json& status, const nlohmann::ordered_json& statistics,
                 MetricText& metrics);

}  // namespace softgrip::web
