#pragma once
// What Prometheus is told of what has happened.

#include <nlohmann/json_fwd.hpp>

#include "tools/web/metrics/metric_text.h"

namespace softgrip::web {

/// `events`: of the statistics of the socket API; `channels`: of its status. Every result of every finger has
/// a sample from the first moment on: an increase from nothing to one would not be seen otherwise.
void tell_events(const nlohmann::ordered_json& events, const nlohmann::ordered_json& channels,
                 MetricText& metrics);

}  // namespace softgrip::web
