#pragma once
// JSON text that another user or program wrote.

#include <string_view>

namespace softgrip {

/// Deepest level of arrays and objects that parse_json() keeps.
inline constexpr int deepest_json = 64;

/// Parses a text with nlohmann's type `Json` (json or ordered_json). Values below the deepest level are left
/// out: the library's copying and printing recurse once per level, so a file of brackets would exhaust the
/// stack. A text that is not JSON gives a discarded value, which is none of object, array, text and number.
template <class Json>
[[nodiscard]] Json parse_json(std::string_view text) {
  return Json::parse(
      text, [](int depth, auto /*event*/, auto& /*value*/) { return depth < deepest_json; }, false);
}

}  // namespace softgrip
