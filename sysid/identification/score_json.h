#pragma once
// Writes logs and scores as JSON. identify.json and validate.json use the same keys. Include this header only
// in source files that write JSON.

#include <cmath>
#include <vector>

#include <nlohmann/json.hpp>

#include "sysid/fitting/score.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Returns a number, or null if it is not finite.
[[nodiscard]] inline nlohmann::ordered_json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

[[nodiscard]] inline nlohmann::ordered_json logs_json(const std::vector<Log>& logs) {
  auto json = nlohmann::ordered_json::array();
  for (const Log& log : logs) {
    nlohmann::ordered_json entry{{"name", log.name}, {"path", log.path}, {"sha256", log.sha256}};
    if (!log.channel.empty()) entry["channel"] = log.channel;
    entry["samples"] = log.size();
    entry["duration_s"] = log.time_s.empty() ? 0 : log.time_s.back() - log.time_s.front();
    for (const LogNote& note : log.notes)
      entry["notes"].push_back({{"line", note.line}, {"text", note.text}});
    json.push_back(std::move(entry));
  }
  return json;
}

/// Adds the keys drive, rmse_mm, rmse_percent_of_span and the keys of the other scores. The value of each key
/// is an object with one entry per log.
inline void add_scores(nlohmann::ordered_json& json, const std::vector<Score>& scores) {
  for (const Score& s : scores) {
    json["drive"][s.name] = name_of(s.drive);
    json["rmse_mm"][s.name] = number_or_null(s.rmse_mm);
    json["rmse_percent_of_span"][s.name] = number_or_null(s.rmse_percent_of_span);
    json["first_cycle_rmse_mm"][s.name] = number_or_null(s.first_cycle_rmse_mm);
    json["settled_rmse_mm"][s.name] = number_or_null(s.settled_rmse_mm);
    json["largest_error_mm"][s.name] = number_or_null(s.largest_error_mm);
  }
}

}  // namespace softgrip::sysid
