#include "tools/web/metrics/metrics.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace softgrip::web::event_metrics_test {
namespace {

using Json = nlohmann::ordered_json;

TEST(EventMetrics, EveryResultIsReportedAsZeroInitially) {
  MetricText metrics;
  add_event_metrics(Json::array(), Json::parse(R"([{"name": "left"}])"), metrics);
  for (const char* result : {"holding", "no_part", "part_lost", "released", "error"}) {
    const std::string label = std::string("result=\"") + result + "\"} 0\n";
    EXPECT_NE(metrics.text().find("softgrip_grip_results_total{channel=\"left\"," + label),
              std::string::npos);
    EXPECT_NE(metrics.text().find("softgrip_results_total{" + label), std::string::npos);
  }
  EXPECT_NE(metrics.text().find("softgrip_sequences_started_total 0\n"), std::string::npos);
}

TEST(EventMetrics, ReportsNothingIfTheEventsAreUnknown) {
  MetricText metrics;
  add_event_metrics(nullptr, Json::array(), metrics);
  EXPECT_EQ(metrics.text(), "");
}

}  // namespace
}  // namespace softgrip::web::event_metrics_test
