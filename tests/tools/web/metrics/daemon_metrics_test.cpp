#include "tools/web/metrics/metrics.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace softgrip::web::daemon_metrics_test {
namespace {

using Json = nlohmann::ordered_json;

std::string told(const Json& status, const Json& statistics) {
  MetricText metrics;
  add_daemon_metrics(status, statistics, metrics);
  return metrics.text();
}

bool has_line(const std::string& text, const std::string& line) {
  return ("\n" + text).find("\n" + line + "\n") != std::string::npos;
}

Json status() {
  return Json::parse(
      R"({"version": "1", "rig": "bench \"a\"", "simulated": false, "time_s": 12.5, "state": "faulted",
    "under_pressure": null, "fault": {"code": "F202", "name": "reading_out_of_range", "channel": "left"},
    "channels": [{"name": "left", "command_kpa": 15, "pressure_kpa": null, "displacement_mm": 12.5, "age_s": 0.004,
      "validity": "valid", "limit": null, "health": "suspect", "health_rms_mm": 0.5,
      "limits": {"pressure_min_kpa": -40, "pressure_max_kpa": 60, "rest_kpa": 0}}],
    "bus": {"connected": true}, "recording": {"active": false, "dropped_rows": 3, "error": null}, "gpio": null,
    "real_time": {"degraded": true}})");
}

Json statistics() {
  return Json::parse(R"({"loop": {"ticks": 100, "slips_woken_late": 2, "slips_took_long": 1,
      "wake_up": {"count": 100, "mean_us": 10, "p50_us": 9, "p99_us": 20, "p999_us": 30, "max_us": 40},
      "compute": {"count": 0, "mean_us": 0, "p50_us": 0, "p99_us": 0, "p999_us": 0, "max_us": 0}},
    "bus": {"exchanges": 99, "failures": 4, "sessions": 1, "slips": 0},
    "events": [{"kind": "grip_result", "code": "PART LOST", "channel": "left", "count": 2},
               {"kind": "overall_result", "code": "PART LOST", "count": 2},
               {"kind": "sequence_started", "count": 5},
               {"kind": "sequence_finished", "code": "stopped", "count": 1},
               {"kind": "fault_latched", "code": "F202", "channel": "left", "count": 1},
               {"kind": "fault_latched", "code": "F202", "channel": "right", "count": 2}]})");
}

TEST(Metrics, AreInBaseUnits) {
  const std::string text = told(status(), statistics());
  for (const char* line : {"softgrip_up 1",
                           "softgrip_build_info{version=\"1\",rig=\"bench \\\"a\\\"\"} 1",
                           "softgrip_uptime_seconds 12.5",
                           "softgrip_state{state=\"faulted\"} 1",
                           "softgrip_state{state=\"idle\"} 0",
                           "softgrip_fault{code=\"F202\",name=\"reading_out_of_range\",channel=\"left\"} 1",
                           "softgrip_pressure_command_pascals{channel=\"left\"} 15000",
                           "softgrip_displacement_meters{channel=\"left\"} 0.0125",
                           "softgrip_reading_age_seconds{channel=\"left\"} 0.004",
                           "softgrip_model_residual_rms_meters{channel=\"left\"} 0.0005",
                           "softgrip_pressure_use_ratio{channel=\"left\"} 0.25",
                           "softgrip_reading_valid{channel=\"left\"} 1",
                           "softgrip_model_health{channel=\"left\",health=\"suspect\"} 1",
                           "softgrip_bus_connected 1",
                           "softgrip_recorder_dropped_rows_total 3",
                           "softgrip_real_time_degraded 1",
                           "softgrip_loop_ticks_total 100",
                           "softgrip_loop_overruns_total{cause=\"woken_late\"} 2",
                           "softgrip_loop_wake_up_seconds{quantile=\"1\"} 0.00004",
                           "softgrip_loop_wake_up_seconds_count 100",
                           "softgrip_bus_errors_total 4"})
    EXPECT_TRUE(has_line(text, line)) << line << "\n" << text;
}

TEST(Metrics, ThePressureUseIsTheDistanceFromRest) {
  for (const auto& [command_kpa, use] : {std::pair{0, "0"}, {15, "0.25"}, {-10, "0.25"}, {-40, "1"}}) {
    Json one = status();
    one["channels"][0]["command_kpa"] = command_kpa;
    EXPECT_TRUE(has_line(told(one, statistics()),
                         std::string("softgrip_pressure_use_ratio{channel=\"left\"} ") + use))
        << command_kpa;
  }
}

TEST(Metrics, CountGripResultsSequencesAndFaults) {
  const std::string text = told(status(), statistics());
  for (const char* line :
       {"softgrip_grip_results_total{channel=\"left\",result=\"part_lost\"} 2",
        "softgrip_grip_results_total{channel=\"left\",result=\"holding\"} 0",
        "softgrip_results_total{result=\"part_lost\"} 2", "softgrip_sequences_started_total 5",
        "softgrip_sequences_ended_total{end=\"stopped\"} 1", "softgrip_sequences_ended_total{end=\"done\"} 0",
        "softgrip_faults_total{code=\"F202\"} 3"})
    EXPECT_TRUE(has_line(text, line)) << line << "\n" << text;
}

TEST(Metrics, OmitMetricsWithUnknownValues) {
  const std::string text = told(status(), statistics());
  EXPECT_EQ(text.find("softgrip_pressure_pascals{"), std::string::npos) << "the pressure is not measured";
  EXPECT_EQ(text.find("softgrip_reference_meters{"), std::string::npos);
  EXPECT_EQ(text.find("softgrip_emergency_stop"), std::string::npos) << "the rig has no digital lines";
  EXPECT_EQ(text.find("softgrip_loop_compute_seconds{"), std::string::npos)
      << "without samples, no quantiles must be reported";
  EXPECT_EQ(text.find("nan"), std::string::npos);
  Json unknown = status();
  unknown.erase("simulated");
  unknown["gpio"] = Json::object();
  const std::string without_flags = told(unknown, statistics());
  EXPECT_EQ(without_flags.find("\nsoftgrip_simulated "), std::string::npos);
  EXPECT_EQ(without_flags.find("\nsoftgrip_emergency_stop "), std::string::npos)
      << "an unknown state of the emergency stop must not be reported as not pressed";
  const std::string gone = told(nullptr, statistics());
  EXPECT_TRUE(has_line(gone, "softgrip_up 0"));
  EXPECT_EQ(gone.find("softgrip_state"), std::string::npos)
      << "without a daemon, the last state must not be reported";
}

}  // namespace
}  // namespace softgrip::web::daemon_metrics_test
