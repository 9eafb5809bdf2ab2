#include "tools/web/metrics/metrics.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace softgrip::web::health_metrics_test {
namespace {

using Json = nlohmann::ordered_json;

std::string told(const Json& health) {
  MetricText metrics;
  add_health_metrics(health, metrics);
  return metrics.text();
}

TEST(HealthMetrics, ReportStateSuspectsAndTimeOfTheCheck) {
  const std::string text = told(Json::parse(R"({"made_unix_s": 1795313181, "fingers": [
    {"finger": "left", "state": "alarm", "suspects": [{"id": "leak"}, {"id": "ageing"}]},
    {"finger": "right", "state": "steady", "suspects": []}]})"));
  for (const char* line : {"softgrip_health_timestamp_seconds 1795313181\n",
                           "softgrip_health_state{channel=\"left\",state=\"alarm\"} 1\n",
                           "softgrip_health_state{channel=\"left\",state=\"steady\"} 0\n",
                           "softgrip_health_state{channel=\"right\",state=\"steady\"} 1\n",
                           "softgrip_health_suspect{channel=\"left\",cause=\"leak\"} 1\n",
                           "softgrip_health_suspect{channel=\"left\",cause=\"ageing\"} 1\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line << text;
  EXPECT_EQ(text.find("channel=\"right\",cause"), std::string::npos);
  EXPECT_EQ(text.find("softgrip_health_shared"), std::string::npos);
}

TEST(HealthMetrics, ReportTheNumbersThatChangedOnAllFingers) {
  const std::string text = told(Json::parse(R"({"fingers": [], "shared": ["gain_mm", 3]})"));
  EXPECT_NE(text.find("softgrip_health_shared{number=\"gain_mm\"} 1\n"), std::string::npos) << text;
}

TEST(HealthMetrics, ReportNothingForMissingOrMalformedResults) {
  EXPECT_EQ(told(nullptr), "");
  for (const char* nonsense : {"{}", R"({"fingers": 3})", R"({"fingers": [1, null, {"suspects": 4}]})"})
    EXPECT_EQ(told(Json::parse(nonsense)).find("} 1\n"), std::string::npos) << nonsense;
}

}  // namespace
}  // namespace softgrip::web::health_metrics_test
