#include "tools/commissioning/examinations.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include "base/json.h"
#include "base/numbers.h"

namespace softgrip::tools::doctor {
namespace {

using Json = nlohmann::ordered_json;

void judge_state(const Json& status, const std::string& rig, Findings& findings) {
  if (!rig.empty() && json_text(status, "rig") != rig) {
    findings.warn("daemon",
                  fmt::format("softgripd runs the rig `{}`, but the rig file describes `{}`",
                              json_text(status, "rig"), rig),
                  "give the rig file with which softgripd was started");
  } else {
    findings.ok("daemon",
                fmt::format("softgripd {}, {}", json_text(status, "version"), json_text(status, "state")));
  }
}

/// Returns true if the channel uses its displacement sensor. The status of an older daemon does not contain
/// this property.
bool uses_displacement(const Json& channel) {
  return json_flag(channel, "displacement_used") || json_member(channel, "displacement_used").is_null();
}

/// Returns the reading of the pressure monitor [kPa]; NaN if there is no valid reading.
double monitored_kpa(const Json& channel) {
  return json_number(channel, "pressure_kpa");
}

/// Returns the name of another finding that explains the latched fault; "" if no finding does, for example
/// because the cause of the fault is no longer present.
std::string judged_elsewhere(const Json& status, const Json& fault) {
  const Json& present = json_member(fault, "present");
  const std::string code = json_text(present, "code");
  const std::string channel = json_text(present, "channel");
  const bool of_bus = code.starts_with("F1") || code.starts_with("F3");
  if (of_bus && channel.empty() && !json_flag(json_member(status, "bus"), "connected")) return "board";
  for (const Json& one : json_list(status, "channels")) {
    if (json_text(one, "name") != channel) continue;
    const bool invalid = uses_displacement(one) && json_text(one, "validity") != "valid";
    if (code == "F208" && std::isnan(monitored_kpa(one))) return "pressure " + channel;
    if (code != "F208" && code.starts_with("F20") && invalid) return "sensor " + channel;
  }
  return {};
}

void judge_fault(const Json& status, Findings& findings) {
  const Json& fault = json_member(status, "fault");
  if (fault.empty()) return;
  const std::string channel = json_text(fault, "channel");
  const std::string title =
      json_text(fault, "code") + " " + json_text(fault, "name") + (channel.empty() ? "" : " of " + channel);
  if (const std::string where = judged_elsewhere(status, fault); !where.empty()) {
    findings.not_judged("fault", title + " is latched, see `" + where + "`");
    return;
  }
  findings.fail("fault", title + ": " + json_text(fault, "meaning"),
                fmt::format("usually {}. {} {}", json_text(fault, "cause"), json_text(fault, "remedy"),
                            json_text(fault, "next")));
}

void judge_real_time(const Json& status, Findings& findings) {
  const Json& real_time = json_member(status, "real_time");
  for (const Json& step : json_list(real_time, "steps")) {
    const std::string name = json_text(step, "name");
    const std::string detail = json_text(step, "detail");
    const bool slow_kernel = name == "kernel" && detail.find("no PREEMPT_RT") != std::string::npos;
    if (json_text(step, "outcome") == "failed") {
      findings.warn(name, detail, "grant this real-time setting, or accept that " + json_text(step, "cost"));
    } else if (slow_kernel) {
      findings.warn(name, detail, "install linux-image-rt-amd64 (Debian) and boot this kernel");
    } else {
      const std::string outcome = json_text(step, "outcome");
      const bool requested = outcome != "not asked for";  // words-ok: documented value
      findings.ok(name, !requested ? "not requested in the rig file" : detail.empty() ? outcome : detail);
    }
  }
}

void judge_loop(const Json& status, const Json& statistics, Findings& findings) {
  const Json& loop = json_member(statistics, "loop");
  const double ticks = json_number(loop, "ticks", 0);
  const double overruns = json_number(loop, "slips_woken_late", 0) + json_number(loop, "slips_took_long", 0);
  const double period_us = 1e6 / std::max(json_number(status, "rate_hz", 0), 1e-3);
  const double p99_us = json_number(json_member(loop, "wake_up"), "p99_us", 0);
  const std::string text =
      fmt::format("{:.0f} ticks, {:.0f} overruns, wake-up latency p99 {:.0f} us, max {:.0f} us", ticks,
                  overruns, p99_us, json_number(json_member(loop, "wake_up"), "max_us", 0));
  if (overruns > 1e-2 * ticks) {
    findings.fail("loop", text,
                  "cycles are missed: see the finding `scheduling of the loop`, lower rate_hz, or reduce the "
                  "load of the processor");
  } else if (overruns > 0 || p99_us > period_us / 10) {
    findings.warn("loop", text, "a few cycles were missed or late: see the finding `scheduling of the loop`");
  } else {
    findings.ok("loop", text);
  }
}

void judge_bus(const Json& status, const Json& statistics, Findings& findings) {
  const Json& bus = json_member(status, "bus");
  const Json& counts = json_member(statistics, "bus");
  const double exchanges = json_number(counts, "exchanges", 0);
  const double failures = json_number(counts, "failures", 0);
  const std::string text =
      fmt::format("{}: {:.0f} exchanges, {:.0f} failed, p99 {:.3g} ms", json_text(bus, "board"), exchanges,
                  failures, json_number(json_member(counts, "exchange"), "p99_us", 0) * 1e-3);
  if (!json_flag(bus, "connected")) {
    const std::string failure = json_text(bus, "failure");
    findings.fail("board",
                  fmt::format("{}; not connected after {:.0f} attempts, one every {:.2g} s{}", text,
                              json_number(bus, "attempts", 0), json_number(bus, "retry_s", 0),
                              failure.empty() ? "" : ". " + failure),
                  std::string(bus_advice(json_text(bus, "failure_kind"))) + "; softgripd reconnects");
  } else if (failures > 1e-3 * exchanges) {
    findings.warn("board", text,
                  "some exchanges fail. Check the cable, the termination, other Modbus clients and rate_hz");
  } else {
    findings.ok("board", text);
  }
}

/// Judges the pressure monitor of a channel. While a sequence runs, the pressure follows the command with a
/// delay, so the two are compared only in the state `idle`.
void judge_pressure(const Json& channel, bool idle, Findings& findings) {
  if (!json_flag(channel, "pressure_measured")) return;
  const Json& limits = json_member(channel, "limits");
  const double kpa = monitored_kpa(channel);
  judge_monitor(json_text(channel, "name"),
                {.pressure_kpa = kpa,
                 .command_kpa = json_number(channel, "command_kpa", 0),
                 .pressure_span_kpa =
                     json_number(limits, "pressure_max_kpa", 0) - json_number(limits, "pressure_min_kpa", 0),
                 .at_rest = idle,
                 .text = fixed(kpa, 2) + (idle ? " kPa at rest" : " kPa")},
                findings);
}

/// Judges the displacement sensor of a channel. Returns true if the model of the finger can be judged.
bool judge_sensor(const Json& channel, Findings& findings) {
  const std::string name = json_text(channel, "name");
  const std::string validity = json_text(channel, "validity");
  if (!uses_displacement(channel)) {
    tell_unused_sensor(name, findings);
    return false;
  }
  if (validity == "valid") {
    findings.ok("sensor " + name,
                fmt::format("{:.3f} mm at {:.2f} kPa", json_number(channel, "displacement_mm", 0),
                            json_number(channel, "command_kpa", 0)));
    return true;
  }
  findings.fail("sensor " + name, "readings are not valid: " + validity,
                "check the display, the wire and the window of the sensor");
  findings.not_judged("model " + name, "see `sensor " + name + "`");
  return false;
}

void judge_model(const Json& channel, bool has_run, Findings& findings) {
  const std::string name = json_text(channel, "name");
  const std::string health = json_text(channel, "health");
  const std::string residual =
      fmt::format("{}, residual {:.2f} mm RMS", health, json_number(channel, "health_rms_mm", 0));
  if (health == "unfit" && !has_run) {
    findings.warn("model " + name, residual,
                  "no sequence has run since softgripd started, and the finger was probably not at rest at "
                  "the start. Run a sequence");
  } else if (health == "unfit") {
    findings.fail(
        "model " + name, residual,
        "record the test signal tp1 and identify the model again; check for wear, leaks or a moved sensor");
  } else if (health == "suspect") {
    findings.warn("model " + name, residual, "calibrate the sensor and identify the model again soon");
  } else {
    findings.ok("model " + name,
                health == "unknown" ? "not checked yet, because no finger has moved" : residual);
  }
}

void judge_channel(const Json& channel, const Json& status, Findings& findings) {
  const std::string name = json_text(channel, "name");
  if (!json_flag(json_member(status, "bus"), "connected")) {
    findings.not_judged("sensor " + name, "see `board`");
    findings.not_judged("model " + name, "see `board`");
    return;
  }
  const bool has_run = !json_member(status, "sequence").empty();
  const bool model_known = judge_sensor(channel, findings);
  judge_pressure(channel, json_text(status, "state") == "idle", findings);
  if (model_known) judge_model(channel, has_run, findings);
}

void judge_rest(const Json& status, Findings& findings) {
  const Json& recording = json_member(status, "recording");
  if (const std::string error = json_text(recording, "error"); !error.empty()) {
    findings.fail("recording", error, "free disk space, or check the permissions of the folder");
  } else if (json_number(recording, "dropped_rows", 0) > 0) {
    findings.warn(
        "recording", fmt::format("{:.0f} rows were lost", json_number(recording, "dropped_rows", 0)),
        "the disk is too slow: use a faster disk, or raise `decimation` under `recorder` in the rig file");
  }
  const Json& gpio = json_member(status, "gpio");
  if (gpio.empty()) return;
  if (json_flag(gpio, "lost")) {
    findings.fail("gpio", "the digital lines cannot be read",
                  "connect the GPIO chip again and restart softgripd");
  } else if (json_flag(gpio, "emergency_stop")) {
    findings.warn("gpio", "the emergency stop is pressed, or has not been released since the start",
                  "release the emergency stop, then run `softgrip acknowledge`");
  } else {
    findings.ok("gpio",
                fmt::format("emergency stop released, enable {}", json_flag(gpio, "enable") ? "on" : "off"));
  }
}

}  // namespace

void examine_daemon(const Json& status, const Json& statistics, const std::string& rig, Findings& findings) {
  judge_state(status, rig, findings);
  judge_fault(status, findings);
  judge_real_time(status, findings);
  judge_loop(status, statistics, findings);
  judge_bus(status, statistics, findings);
  for (const Json& channel : json_list(status, "channels")) judge_channel(channel, status, findings);
  judge_rest(status, findings);
}

}  // namespace softgrip::tools::doctor
