#pragma once
// Reads JSON members that may be missing.

#include <limits>
#include <string>

#include <nlohmann/json.hpp>

namespace softgrip::web {

/// Returns the member at `key` of an object, or null if the member is missing.
[[nodiscard]] inline const nlohmann::ordered_json& member(const nlohmann::ordered_json& object,
                                                          const char* key) {
  static const nlohmann::ordered_json none;
  if (!object.is_object()) return none;
  const auto found = object.find(key);
  return found == object.end() ? none : *found;
}

/// Returns the number at `key`, or NaN if the member is missing.
[[nodiscard]] inline double number(const nlohmann::ordered_json& object, const char* key) {
  const nlohmann::ordered_json& value = member(object, key);
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

/// Returns 1 for true and 0 for false. Returns NaN if the member is not a Boolean.
[[nodiscard]] inline double flag(const nlohmann::ordered_json& object, const char* key) {
  const nlohmann::ordered_json& value = member(object, key);
  if (!value.is_boolean()) return std::numeric_limits<double>::quiet_NaN();
  return value.get<bool>() ? 1 : 0;
}

/// Returns the text at `key`, or "" if the member is missing.
[[nodiscard]] inline std::string text(const nlohmann::ordered_json& object, const char* key) {
  const nlohmann::ordered_json& value = member(object, key);
  return value.is_string() ? value.get<std::string>() : std::string();
}

}  // namespace softgrip::web
