#include "tools/web/metrics/metrics.h"

#include <limits>

#include <nlohmann/json.hpp>

#include "base/json.h"

namespace softgrip::web {

namespace {

using Json = nlohmann::ordered_json;
using enum MetricText::Type;

constexpr double us_per_s = 1e6;

/// Returns 1 for true and 0 for false. Returns NaN if the member `key` is not a Boolean.
double flag_value(const Json& object, const char* key) {
  const Json& value = json_member(object, key);
  if (!value.is_boolean()) return std::numeric_limits<double>::quiet_NaN();
  return value.get<bool>() ? 1 : 0;
}

void add_metric(MetricText& metrics, std::string_view name, MetricText::Type type, std::string_view help,
                double value) {
  metrics.family(name, type, help);
  metrics.sample(value);
}

void add_state_metrics(const Json& status, MetricText& metrics) {
  metrics.family("softgrip_build_info", gauge,
                 "Always 1; the labels state the version of softgripd and the name of the rig.");
  metrics.sample({{"version", status.value("version", "")}, {"rig", status.value("rig", "")}}, 1);
  add_metric(metrics, "softgrip_simulated", gauge,
             "1 if the daemon uses a simulated board instead of a real board.",
             flag_value(status, "simulated"));
  add_metric(metrics, "softgrip_uptime_seconds", gauge, "Time since the daemon's start.",
             json_number(status, "time_s"));
  metrics.family("softgrip_state", gauge, "1 for the present state of the rig, 0 for the other states.");
  const std::string state = status.value("state", "");
  for (const char* name : {"starting", "idle", "resynchronising", "running", "stopping", "faulted"})
    metrics.sample({{"state", name}}, state == name ? 1 : 0);
  metrics.family("softgrip_fault", gauge,
                 "1 for the latched fault. The metric is absent if no fault is latched.");
  if (const Json& fault = json_member(status, "fault"); fault.is_object()) {
    const std::string channel = fault.contains("channel") && fault["channel"].is_string()
                                    ? fault["channel"].get<std::string>()
                                    : std::string();
    metrics.sample(
        {{"code", fault.value("code", "")}, {"name", fault.value("name", "")}, {"channel", channel}}, 1);
  }
  add_metric(metrics, "softgrip_under_pressure", gauge, "1 if no sequence runs and fingers are pressurised.",
             json_member(status, "under_pressure").is_object() ? 1 : 0);
}

void add_digital_line_metrics(const Json& status, MetricText& metrics) {
  const Json& lines = json_member(status, "gpio");
  if (!lines.is_object()) return;
  add_metric(metrics, "softgrip_emergency_stop", gauge, "1 while the emergency stop is pressed.",
             flag_value(lines, "emergency_stop"));
  add_metric(metrics, "softgrip_digital_lines_lost", gauge,
             "1 if the daemon can no longer read the digital lines.", flag_value(lines, "lost"));
}

/// Writes a summary of the durations that the daemon has recorded since its start.
void add_durations(MetricText& metrics, const std::string& name, std::string_view help,
                   const Json& histogram) {
  if (!histogram.is_object()) return;
  metrics.family(name, summary, help);
  const double count = json_number(histogram, "count");
  if (count > 0) {
    for (const auto& [quantile, key] : {std::pair{"0.5", "p50_us"}, std::pair{"0.99", "p99_us"},
                                        std::pair{"0.999", "p999_us"}, std::pair{"1", "max_us"}})
      metrics.sample({{"quantile", quantile}}, json_number(histogram, key) / us_per_s);
  }
  metrics.sample({}, json_number(histogram, "mean_us") * count / us_per_s, "_sum");
  metrics.sample({}, count, "_count");
}

void add_loop_metrics(const Json& loop, MetricText& metrics) {
  add_metric(metrics, "softgrip_loop_ticks_total", counter, "Number of ticks (cycles) of the control loop.",
             json_number(loop, "ticks"));
  metrics.family("softgrip_loop_overruns_total", counter,
                 "Number of missed cycles of the control loop, by cause.");
  metrics.sample({{"cause", "woken_late"}}, json_number(loop, "slips_woken_late"));
  metrics.sample({{"cause", "took_long"}}, json_number(loop, "slips_took_long"));
  add_durations(
      metrics, "softgrip_loop_wake_up_seconds",
      "Wake-up latency of the control loop: time from the scheduled to the actual beginning of a tick.",
      json_member(loop, "wake_up"));
  add_durations(metrics, "softgrip_loop_compute_seconds", "Computing time of the control loop in one tick.",
                json_member(loop, "compute"));
  add_durations(metrics, "softgrip_loop_reading_age_seconds",
                "Age of the oldest reading at the time at which the control loop uses this reading.",
                json_member(loop, "reading_age"));
}

void add_bus_metrics(const Json& bus, MetricText& metrics) {
  add_metric(metrics, "softgrip_bus_exchanges_total", counter,
             "Number of exchanges with the board, both successful and failed.",
             json_number(bus, "exchanges"));
  add_metric(metrics, "softgrip_bus_errors_total", counter,
             "Number of failed exchanges with the board and failed attempts to connect.",
             json_number(bus, "failures"));
  add_metric(metrics, "softgrip_bus_sessions_total", counter,
             "Number of sessions with the board that were opened.", json_number(bus, "sessions"));
  add_metric(metrics, "softgrip_bus_overruns_total", counter, "Number of missed cycles of the bus thread.",
             json_number(bus, "slips"));
  add_durations(metrics, "softgrip_bus_exchange_seconds", "Duration of successful exchanges.",
                json_member(bus, "exchange"));
}

void add_recorder_metrics(const Json& recording, MetricText& metrics) {
  add_metric(metrics, "softgrip_recorder_active", gauge, "1 while a recording is written.",
             flag_value(recording, "active"));
  add_metric(metrics, "softgrip_recorder_failed", gauge, "1 if the last recording could not be written.",
             json_member(recording, "error").is_string() ? 1 : 0);
  add_metric(metrics, "softgrip_recorder_dropped_rows_total", counter,
             "Number of rows that were not recorded because the disk was too slow.",
             json_number(recording, "dropped_rows"));
}

}  // namespace

void add_daemon_metrics(const Json& status, const Json& statistics, MetricText& metrics) {
  add_metric(metrics, "softgrip_up", gauge, "1 if softgripd responds.", status.is_object() ? 1 : 0);
  if (!status.is_object()) return;
  add_state_metrics(status, metrics);
  add_digital_line_metrics(status, metrics);
  add_channel_metrics(json_member(status, "channels"), metrics);
  add_metric(metrics, "softgrip_bus_connected", gauge, "1 while the board responds.",
             flag_value(json_member(status, "bus"), "connected"));
  add_recorder_metrics(json_member(status, "recording"), metrics);
  if (const Json& real_time = json_member(status, "real_time"); real_time.is_object())
    add_metric(metrics, "softgrip_real_time_degraded", gauge,
               "1 if the operating system did not grant a requested real-time setting.",
               flag_value(real_time, "degraded"));
  if (!statistics.is_object()) return;
  add_loop_metrics(json_member(statistics, "loop"), metrics);
  add_bus_metrics(json_member(statistics, "bus"), metrics);
  add_event_metrics(json_member(statistics, "events"), json_member(status, "channels"), metrics);
}

}  // namespace softgrip::web
