#include "tools/web/metrics/daemon_metrics.h"

#include <array>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "tools/web/metrics/channel_metrics.h"
#include "tools/web/metrics/event_metrics.h"
#include "tools/web/metrics/json_member.h"

namespace softgrip::web {

namespace {

using Json = nlohmann::ordered_json;
using enum MetricText::Type;

constexpr double us_per_s = 1e6;

void tell_one(MetricText& metrics, std::string_view name, MetricText::Type type, std::string_view help,
              double value) {
  metrics.family(name, type, help);
  metrics.sample(value);
}

void tell_state(const Json& status, MetricText& metrics) {
  metrics.family("softgrip_build_info", gauge, "Always 1: version of softgripd and name of the rig.");
  metrics.sample({{"version", status.value("version", "")}, {"rig", status.value("rig", "")}}, 1);
  tell_one(metrics, "softgrip_simulated", gauge,
           "1 if the daemon uses a simulated board instead of a real board.", flag(status, "simulated"));
  tell_one(metrics, "softgrip_uptime_seconds", gauge, "Time since the daemon's start.",
           number(status, "time_s"));
  metrics.family("softgrip_state", gauge, "1 for the present state of the rig, 0 for the other states.");
  const std::string state = status.value("state", "");
  for (const char* name : {"starting", "idle", "resynchronising", "running", "stopping", "faulted"})
    metrics.sample({{"state", name}}, state == name ? 1 : 0);
  metrics.family("softgrip_fault", gauge,
                 "1 for the latched fault. The metric is absent if no fault is latched.");
  if (const Json& fault = member(status, "fault"); fault.is_object()) {
    const std::string channel = fault.contains("channel") && fault["channel"].is_string()
                                    ? fault["channel"].get<std::string>()
                                    : std::string();
    metrics.sample(
        {{"code", fault.value("code", "")}, {"name", fault.value("name", "")}, {"channel", channel}}, 1);
  }
  tell_one(metrics, "softgrip_under_pressure", gauge, "1 if no sequence runs and fingers are pressurised.",
           member(status, "under_pressure").is_object() ? 1 : 0);
}

void tell_lines(const Json& status, MetricText& metrics) {
  const Json& lines = member(status, "gpio");
  if (!lines.is_object()) return;
  tell_one(metrics, "softgrip_emergency_stop", gauge, "1 while the emergency stop is pressed.",
           flag(lines, "emergency_stop"));
  tell_one(metrics, "softgrip_digital_lines_lost", gauge,
           "1 if the daemon can no longer read the digital lines.", flag(lines, "lost"));
}

/// Writes a summary of the durations that the daemon has measured since its start.
void tell_durations(MetricText& metrics, const std::string& name, std::string_view help,
                    const Json& histogram) {
  if (!histogram.is_object()) return;
  metrics.family(name, summary, help);
  const double count = number(histogram, "count");
  if (count > 0) {
    for (const auto& [quantile, key] : {std::pair{"0.5", "p50_us"}, std::pair{"0.99", "p99_us"},
                                        std::pair{"0.999", "p999_us"}, std::pair{"1", "max_us"}})
      metrics.sample({{"quantile", quantile}}, number(histogram, key) / us_per_s);
  }
  metrics.sample({}, number(histogram, "mean_us") * count / us_per_s, "_sum");
  metrics.sample({}, count, "_count");
}

void tell_loop(const Json& loop, MetricText& metrics) {
  tell_one(metrics, "softgrip_loop_ticks_total", counter, "Ticks of the control loop.",
           number(loop, "ticks"));
  metrics.family("softgrip_loop_overruns_total", counter, "Missed cycles of the control loop, by cause.");
  metrics.sample({{"cause", "woken_late"}}, number(loop, "slips_woken_late"));
  metrics.sample({{"cause", "took_long"}}, number(loop, "slips_took_long"));
  tell_durations(metrics, "softgrip_loop_wake_up_seconds",
                 "Wake-up latency: from the scheduled time to the beginning of the tick.",
                 member(loop, "wake_up"));
  tell_durations(metrics, "softgrip_loop_compute_seconds", "Duration of a tick.", member(loop, "compute"));
  tell_durations(metrics, "softgrip_loop_reading_age_seconds",
                 "Age of the oldest reading when the tick uses this reading.", member(loop, "reading_age"));
}

void tell_bus(const Json& bus, MetricText& metrics) {
  tell_one(metrics, "softgrip_bus_exchanges_total", counter,
           "Exchanges with the board, successful and failed.", number(bus, "exchanges"));
  tell_one(metrics, "softgrip_bus_errors_total", counter,
           "Number of failed exchanges with the board and failed attempts to connect.",
           number(bus, "failures"));
  tell_one(metrics, "softgrip_bus_sessions_total", counter, "Sessions that were opened with the board.",
           number(bus, "sessions"));
  tell_one(metrics, "softgrip_bus_overruns_total", counter, "Missed cycles of the bus.",
           number(bus, "slips"));
  tell_durations(metrics, "softgrip_bus_exchange_seconds", "Duration of successful exchanges.",
                 member(bus, "exchange"));
}

void tell_recorder(const Json& recording, MetricText& metrics) {
  tell_one(metrics, "softgrip_recorder_active", gauge, "1 while a recording is written.",
           flag(recording, "active"));
  tell_one(metrics, "softgrip_recorder_failed", gauge, "1 if the last recording could not be written.",
           member(recording, "error").is_string() ? 1 : 0);
  tell_one(metrics, "softgrip_recorder_dropped_rows_total", counter,
           "Rows that were not recorded because the disk was too slow.", number(recording, "dropped_rows"));
}

}  // namespace

void tell_daemon(const Json& status, const Json& statistics, MetricText& metrics) {
  tell_one(metrics, "softgrip_up", gauge, "1 if softgripd responds.", status.is_object() ? 1 : 0);
  if (!status.is_object()) return;
  tell_state(status, metrics);
  tell_lines(status, metrics);
  tell_channels(member(status, "channels"), metrics);
  tell_one(metrics, "softgrip_bus_connected", gauge, "1 while the board responds.",
           flag(member(status, "bus"), "connected"));
  tell_recorder(member(status, "recording"), metrics);
  if (const Json& real_time = member(status, "real_time"); real_time.is_object())
    tell_one(metrics, "softgrip_real_time_degraded", gauge, "1 if a real-time setting was not granted.",
             flag(real_time, "degraded"));
  if (!statistics.is_object()) return;
  tell_loop(member(statistics, "loop"), metrics);
  tell_bus(member(statistics, "bus"), metrics);
  tell_events(member(statistics, "events"), member(status, "channels"), metrics);
}

}  // namespace softgrip::web
