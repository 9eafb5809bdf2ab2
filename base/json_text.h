#pragma once
// Parses JSON text of other users and programs.

#include <string_view>

namespace softgrip {

/// Depth of nested arrays and objects that parse_json() keeps.
inline constexpr int deepest_json = 64;

/// Parses a text with nlohmann's type `Json` (json or ordered_json). Deeper values are omitted, because the
/// library's copy and print functions recurse once per level, and a text of brackets would exhaust the stack.
/// Invalid JSON gives a discarded value, which is not an object, array, text or number.
template <class Json>
[[nodiscard]] Json parse_json(std::string_view text) {
  return Json::parse(
      text, [](int depth, auto /*event*/, auto& /*value*/) { return depth < deepest_json; }, false);
}

}  // namespace softgrip
