#pragma once
// Members of JSON that may be missing.

#include <limits>
#include <string>

#include <nlohmann/json.hpp>

namespace softgrip::web {

/// A member of an object; null where there is none.
[[nodiscard]] inline const nlohmann::ordered_json& member(const nlohmann::ordered_json& object,
                                                          const char* key) {
  static const nlohmann::ordered_json none;
  if (!object.is_object()) return none;
  const auto found = object.find(key);
  return found == object.end() ? none : *found;
}

/// NaN where there is no number.
[[nodiscard]] inline double number(const nlohmann::ordered_json& object, const char* key) {
  const nlohmann::ordered_json& value = member(object, key);
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

/// 1 or 0; NaN where there is neither true nor false.
[[nodiscard]] inline double flag(const nlohmann::ordered_json& object, const char* key) {
  const nlohmann::ordered_json& value = member(object, key);
  if (!value.is_boolean()) return std::numeric_limits<double>::quiet_NaN();
  return value.get<bool>() ? 1 : 0;
}

/// Empty where there is no text.
[[nodiscard]] inline std::string text(const nlohmann::ordered_json& object, const char* key) {
  const nlohmann::ordered_json& value = member(object, key);
  return value.is_string() ? value.get<std::string>() : std::string();
}

}  // namespace softgrip::web
