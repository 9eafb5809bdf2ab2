#include "tools/commissioning/daemon_examination.h"

#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include "tools/commissioning/bus_advice.h"

namespace softgrip::tools::doctor {
namespace {

using Json = nlohmann::ordered_json;

std::string text_in(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string{};
}

double number_in(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? found->get<double>() : 0;
}

bool is_set(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_boolean() && found->get<bool>();
}

Json part(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_object() ? *found : Json::object();
}

Json list_in(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_array() ? *found : Json::array();
}

void judge_state(const Json& status, const std::string& rig, Findings& findings) {
  if (!rig.empty() && text_in(status, "rig") != rig) {
    findings.warn("daemon",
                  fmt::format("softgripd runs the rig `{}`, but the rig file describes `{}`",
                              text_in(status, "rig"), rig),
                  "give the rig file with which softgripd was started");
  } else {
    findings.ok("daemon",
                fmt::format("softgripd {}, {}", text_in(status, "version"), text_in(status, "state")));
  }
}

/// Returns the name of the finding that explains the latched fault, or "" if the cause of the fault is no
/// longer present.
std::string judged_elsewhere(const Json& status, const Json& fault) {
  const Json present = part(fault, "present");
  const std::string code = text_in(present, "code");
  const std::string channel = text_in(present, "channel");
  const bool of_bus = code.starts_with("F1") || code.starts_with("F3");
  if (of_bus && channel.empty() && !is_set(part(status, "bus"), "connected")) return "board";
  for (const Json& one : list_in(status, "channels")) {
    const bool invalid = text_in(one, "validity") != "valid";
    if (code.starts_with("F20") && invalid && text_in(one, "name") == channel) return "sensor " + channel;
  }
  return {};
}

void judge_fault(const Json& status, Findings& findings) {
  const Json fault = part(status, "fault");
  if (fault.empty()) return;
  const std::string channel = text_in(fault, "channel");
  const std::string title =
      text_in(fault, "code") + " " + text_in(fault, "name") + (channel.empty() ? "" : " of " + channel);
  if (const std::string where = judged_elsewhere(status, fault); !where.empty()) {
    findings.not_judged("fault", title + " is latched, see `" + where + "`");
    return;
  }
  findings.fail("fault", title + ": " + text_in(fault, "meaning"),
                fmt::format("usually {}. {} {}", text_in(fault, "cause"), text_in(fault, "remedy"),
                            text_in(fault, "next")));
}

void judge_real_time(const Json& status, Findings& findings) {
  const Json real_time = part(status, "real_time");
  for (const Json& step : list_in(real_time, "steps")) {
    const std::string name = text_in(step, "name");
    const std::string detail = text_in(step, "detail");
    const bool slow_kernel = name == "kernel" && detail.find("no PREEMPT_RT") != std::string::npos;
    if (text_in(step, "outcome") == "failed") {
      findings.warn(name, detail, "grant this real-time setting, or accept that " + text_in(step, "cost"));
    } else if (slow_kernel) {
      findings.warn(name, detail, "install linux-image-rt-amd64 (Debian) and boot this kernel");
    } else {
      findings.ok(name, detail.empty() ? text_in(step, "outcome") : detail);
    }
  }
}

void judge_loop(const Json& status, const Json& statistics, Findings& findings) {
  const Json loop = part(statistics, "loop");
  const double ticks = number_in(loop, "ticks");
  const double overruns = number_in(loop, "slips_woken_late") + number_in(loop, "slips_took_long");
  const double period_us = 1e6 / std::max(number_in(status, "rate_hz"), 1e-3);
  const double p99_us = number_in(part(loop, "wake_up"), "p99_us");
  const std::string text =
      fmt::format("{:.0f} ticks, {:.0f} overruns, wake-up latency p99 {:.0f} us, max {:.0f} us", ticks,
                  overruns, p99_us, number_in(part(loop, "wake_up"), "max_us"));
  if (overruns > 1e-2 * ticks) {
    findings.fail("loop", text,
                  "cycles are missed: see the finding `scheduling`, lower rate_hz, or reduce the load of the "
                  "processor");
  } else if (overruns > 0 || p99_us > period_us / 10) {
    findings.warn("loop", text, "cycles were missed or late occasionally: see the finding `scheduling`");
  } else {
    findings.ok("loop", text);
  }
}

void judge_bus(const Json& status, const Json& statistics, Findings& findings) {
  const Json bus = part(status, "bus");
  const Json counts = part(statistics, "bus");
  const double exchanges = number_in(counts, "exchanges");
  const double failures = number_in(counts, "failures");
  const std::string text =
      fmt::format("{}: {:.0f} exchanges, {:.0f} failed, p99 {:.3g} ms", text_in(bus, "board"), exchanges,
                  failures, number_in(part(counts, "exchange"), "p99_us") * 1e-3);
  if (!is_set(bus, "connected")) {
    const std::string failure = text_in(bus, "failure");
    findings.fail("board",
                  fmt::format("{}; not connected, tried {:.0f} times, every {:.2g} s{}", text,
                              number_in(bus, "attempts"), number_in(bus, "retry_s"),
                              failure.empty() ? "" : ". " + failure),
                  std::string(bus_advice(text_in(bus, "failure_kind"))) + "; softgripd reconnects");
  } else if (failures > 1e-3 * exchanges) {
    findings.warn("board", text,
                  "some exchanges fail. Check the cable, the termination, other Modbus clients and rate_hz");
  } else {
    findings.ok("board", text);
  }
}

void judge_channel(const Json& channel, bool connected, bool has_run, Findings& findings) {
  const std::string name = text_in(channel, "name");
  const std::string validity = text_in(channel, "validity");
  if (!connected) {
    findings.not_judged("sensor " + name, "see `board`");
    findings.not_judged("model " + name, "see `board`");
    return;
  }
  const std::string text = fmt::format("{:.3f} mm at {:.2f} kPa", number_in(channel, "displacement_mm"),
                                       number_in(channel, "command_kpa"));
  if (validity == "valid") {
    findings.ok("sensor " + name, text);
  } else {
    findings.fail("sensor " + name, "readings are not valid: " + validity,
                  "check the display, the wire and the window of the sensor");
    findings.not_judged("model " + name, "see `sensor " + name + "`");
    return;
  }
  const std::string health = text_in(channel, "health");
  const std::string residual =
      fmt::format("{}, residual {:.2f} mm RMS", health, number_in(channel, "health_rms_mm"));
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

void judge_rest(const Json& status, Findings& findings) {
  const Json recording = part(status, "recording");
  if (const std::string error = text_in(recording, "error"); !error.empty()) {
    findings.fail("recording", error, "free disk space, or check the permissions of the folder");
  } else if (number_in(recording, "dropped_rows") > 0) {
    findings.warn(
        "recording", fmt::format("{:.0f} rows were lost", number_in(recording, "dropped_rows")),
        "the disk is too slow: use a faster disk, or raise `decimation` under `recorder` in the rig file");
  }
  const Json gpio = part(status, "gpio");
  if (gpio.empty()) return;
  if (is_set(gpio, "lost")) {
    findings.fail("gpio", "the digital lines cannot be read",
                  "connect the GPIO chip again and restart softgripd");
  } else if (is_set(gpio, "emergency_stop")) {
    findings.warn("gpio", "the emergency stop is pressed, or has not been released since the start",
                  "release the emergency stop, then run `softgrip acknowledge`");
  } else {
    findings.ok("gpio",
                fmt::format("emergency stop released, enable {}", is_set(gpio, "enable") ? "on" : "off"));
  }
}

}  // namespace

void examine_daemon(const Json& status, const Json& statistics, const std::string& rig, Findings& findings) {
  judge_state(status, rig, findings);
  judge_fault(status, findings);
  judge_real_time(status, findings);
  judge_loop(status, statistics, findings);
  judge_bus(status, statistics, findings);
  const bool has_run = !part(status, "sequence").empty();
  for (const Json& channel : list_in(status, "channels")) {
    judge_channel(channel, is_set(part(status, "bus"), "connected"), has_run, findings);
  }
  judge_rest(status, findings);
}

}  // namespace softgrip::tools::doctor
