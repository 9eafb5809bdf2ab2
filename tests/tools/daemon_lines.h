#pragma once
// Lines in the form in which softgripd sends them, and damaged copies of these lines.

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace softgrip::tools::testing {

using Json = nlohmann::ordered_json;

inline Json good_status() {
  Json status = Json::parse(R"({"version": "1.0", "rig": "bench", "rig_file": null, "simulated": false,
    "rate_hz": 200, "time_s": 12.3, "state": "faulted", "result": "HOLDING",
    "under_pressure": {"channels": [{"name": "left", "command_kpa": 3}], "command": "softgrip release", "text": "t"},
    "fault": {"code": "F202", "name": "n", "meaning": "m", "cause": "c", "remedy": "r", "channel": "left",
              "present": {"code": "F202", "name": "n", "channel": null}, "next": "x"},
    "sequence": {"name": "pick", "request": 3, "client": null, "parameters": {"a": 1}, "step": 0, "step_name": "s",
                 "steps": 2, "ended": null},
    "bus": {"board": "b", "connected": false, "fault": null, "consecutive_failures": 0, "answered": true,
            "attempts": 3, "retry_s": 0.5, "failure": "f"},
    "loop": {"ticks": 9, "slips": 1, "wake_up_p99_us": 43.2, "wake_up_max_us": 120},
    "recording": {"active": true, "folder": "/r", "rows": 1, "dropped_rows": 0, "error": null},
    "gpio": {"emergency_stop": true, "part_in_position": null, "enable": false, "lost": false},
    "real_time": {"degraded": true, "steps": [{"name": "kernel", "outcome": "failed", "detail": "d", "cost": "c"}]},
    "owner": null})");
  const Json channel = Json::parse(
      R"({"name": "left", "command_kpa": 30.0, "pressure_kpa": 29.5, "temperature_c": 20, "displacement_mm": 12.2,
    "reference_mm": 12.5, "squeeze_kpa": 4, "deficit_mm": 1, "age_s": 0.003, "validity": "valid", "result": "HOLDING",
    "evidence": "displacement", "saturated": false, "slewing": true, "limit": "slew", "limit_text": "l",
    "health": "healthy", "health_rms_mm": 0.1, "limits": {"pressure_min_kpa": 0, "pressure_max_kpa": 60,
    "displacement_min_mm": 0, "displacement_max_mm": 25}})");
  status["channels"] = {channel, channel};
  return status;
}

/// Returns one line of each kind that softgripd sends.
inline std::vector<Json> good_lines() {
  const Json problem = Json::parse(
      R"({"file": "a.yaml", "line": 3, "column": 5, "line_text": "x", "message": "no", "hint": "h"})");
  const Json event = Json::parse(R"({"id": 7, "time_s": 1.5, "kind": "sequence_finished", "severity": "error",
    "channel": "left", "code": "done", "request": 3, "client": "cell", "value": 1.5, "parameters": {"a": 4},
    "text": "t", "at": "2026-11-21T09:00:00.000Z"})");
  const Json parameter = Json::parse(
      R"({"name": "squeeze_kpa", "unit": "kpa", "lower": 0, "upper": 9, "default": 4, "about": "a"})");
  const auto accepted = [](Json result) {
    return Json{{"id", 1}, {"ok", true}, {"result", std::move(result)}};
  };
  const auto declined = [](Json error) {
    return Json{{"id", nullptr}, {"ok", false}, {"error", std::move(error)}};
  };
  const Json histogram = {{"count", 9}, {"min_us", 1}, {"mean_us", 2}, {"p50_us", 2}, {"p99_us", 3}};
  return {
      {{"id", 2}, {"watch", good_status()}},
      {{"id", 3}, {"event", event}},
      accepted(good_status()),
      accepted({{"request", 3}, {"warnings", {problem}}}),
      accepted({{"request", 3}, {"acknowledged", {{"code", "F202"}, {"name", "n"}, {"channel", nullptr}}}}),
      accepted({{"events", {event, event}}, {"newest", 7}}),
      accepted({{"sequences",
                 {{{"name", "p"}, {"about", "a"}, {"parameters", {parameter}}, {"problems", {problem}}}}}}),
      accepted(
          {{"loop", {{"ticks", 9}, {"slips_woken_late", 1}, {"slips_took_long", 0}, {"wake_up", histogram}}},
           {"bus", {{"exchanges", 9}, {"failures", 0}, {"exchange", histogram}}},
           {"events", {{{"kind", "fault"}, {"code", "F202"}, {"channel", "left"}, {"count", 2}}}}}),
      accepted({{"api", 1}, {"version", "1"}, {"capabilities", {"start_id", "owner"}}}),
      accepted({{"since", 3}, {"oldest", 1}, {"newest", 9}, {"started_at", "x"}}),
      accepted(Json::object()),
      declined({{"code", "refused"},
                {"message", "m"},
                {"refusal", {{"code", "R12"}, {"name", "named_start_not_running"}}},
                {"request", 4}}),
      declined({{"code", "sequence_refused"}, {"message", "m"}, {"problems", {problem}}}),
      declined({{"code", "owned"}, {"message", "m"}, {"owner", "cell"}}),
  };
}

/// Returns damaged copies of a line. In each copy, one value of the line is missing or replaced by another
/// JSON value.
inline std::vector<Json> damaged(const Json& line) {
  const Json others =
      Json::parse(R"([null, true, 0, -1, 1.5, 1e300, "", "x", [], [1], [[]], {}, {"a": null}])");
  std::vector<Json> lines;
  const Json flat = line.flatten();
  std::vector<std::string> places;
  for (const auto& [leaf, value] : flat.items()) {
    // Add the path of each value between the root of the line and this leaf. Skip paths that the list already
    // contains.
    for (std::size_t end = 0; end != std::string::npos;) {
      end = leaf.find('/', end + 1);
      const std::string place = leaf.substr(0, end);
      if (std::find(places.begin(), places.end(), place) == places.end()) places.push_back(place);
    }
  }
  for (const std::string& place : places) {
    for (const Json& other : others) {
      lines.push_back(line);
      lines.back()[Json::json_pointer(place)] = other;
    }
    lines.push_back(line.patch(Json::array({{{"op", "remove"}, {"path", place}}})));
  }
  return lines;
}

}  // namespace softgrip::tools::testing
