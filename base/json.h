#pragma once
// Reads members of JSON objects that come from other programs. A member may be missing or of an unexpected
// type.
// Parses JSON text that comes from other users and programs, and writes JSON text.

#include <limits>
#include <string>
#include <string_view>

namespace softgrip {

/// Returns the member at `key` of an object. Returns null if the member is missing, or if `object` is not an
/// object. `Json` is nlohmann's json or ordered_json.
template <class Json>
[[nodiscard]] const Json& json_member(const Json& object, std::string_view key) {
  static const Json none;
  if (!object.is_object()) return none;
  const auto found = object.find(key);
  return found == object.end() ? none : *found;
}

/// Returns the number at `key`, or `missing` if there is no number.
template <class Json>
[[nodiscard]] double json_number(const Json& object, std::string_view key,
                                 double missing = std::numeric_limits<double>::quiet_NaN()) {
  const Json& value = json_member(object, key);
  return value.is_number() ? value.template get<double>() : missing;
}

/// Returns the text at `key`, or "" if there is no text.
template <class Json>
[[nodiscard]] std::string json_text(const Json& object, std::string_view key) {
  const Json& value = json_member(object, key);
  return value.is_string() ? value.template get<std::string>() : std::string();
}

/// Returns true if the member at `key` is the Boolean value true.
template <class Json>
[[nodiscard]] bool json_flag(const Json& object, std::string_view key) {
  const Json& value = json_member(object, key);
  return value.is_boolean() && value.template get<bool>();
}

/// Returns the list at `key`, or an empty list if there is no list.
template <class Json>
[[nodiscard]] const Json& json_list(const Json& object, std::string_view key) {
  static const Json none = Json::array();
  const Json& value = json_member(object, key);
  return value.is_array() ? value : none;
}

/// Returns a value as text. Bytes that are not UTF-8 are replaced, so that a name from a file system cannot
/// prevent the output. A negative indent means one line.
template <class Json>
[[nodiscard]] std::string json_dump(const Json& value, int indent = -1) {
  return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// Largest depth of nested arrays and objects; parse_json() omits deeper values.
inline constexpr int deepest_json = 64;

/// Parses a text with nlohmann's type `Json` (json or ordered_json). Values that are nested deeper than
/// deepest_json are omitted. The copy and print functions of the nlohmann library recurse once per level, so
/// a deeply nested value would exhaust the stack. For invalid JSON, the result is a discarded value, for
/// which is_discarded() returns true.
template <class Json>
[[nodiscard]] Json parse_json(std::string_view text) {
  return Json::parse(
      text, [](int depth, auto /*event*/, auto& /*value*/) { return depth < deepest_json; }, false);
}

}  // namespace softgrip
