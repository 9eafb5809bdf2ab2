#include "tools/web/metrics/metrics.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace softgrip::web::channel_metrics_test {
namespace {

using Json = nlohmann::ordered_json;

TEST(ChannelMetrics, EachChannelHasSeparateMetrics) {
  MetricText metrics;
  add_channel_metrics(
      Json::parse(
          R"([{"name": "left", "pressure_kpa": 1.5, "temperature_c": 23.5, "validity": "valid", "limit": "rig_pressure"},
                                {"name": "right", "pressure_kpa": 2, "validity": "frozen", "limit": null}])"),
      metrics);
  for (const char* line :
       {"softgrip_pressure_pascals{channel=\"left\"} 1500\nsoftgrip_pressure_pascals{channel=\"right\"} "
        "2000\n",
        "softgrip_temperature_celsius{channel=\"left\"} 23.5\n",
        "softgrip_reading_valid{channel=\"left\"} 1\nsoftgrip_reading_valid{channel=\"right\"} 0\n",
        "softgrip_pressure_limited{channel=\"left\"} 1\nsoftgrip_pressure_limited{channel=\"right\"} 0\n"})
    EXPECT_NE(metrics.text().find(line), std::string::npos) << line << metrics.text();
}

}  // namespace
}  // namespace softgrip::web::channel_metrics_test
