#pragma once
// Parses JSON text that comes from other users and programs.

#include <string_view>

namespace softgrip {

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
