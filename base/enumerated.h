#pragma once
// Joins several texts into one, for messages.

#include <cstddef>
#include <functional>
#include <iterator>
#include <string>
#include <string_view>

namespace softgrip {

/// Joins the texts of `items` in their order. If `before_last` is " and ", the result is, for example, "a, b
/// and c". If `items` is empty, the result is empty. `text_of` returns a std::string or std::string_view for
/// an item, or is a pointer to the member that contains the text.
template <typename Items, typename TextOf = std::identity>
[[nodiscard]] std::string enumerated(const Items& items, std::string_view before_last, TextOf text_of = {}) {
  std::string text;
  const std::size_t count = std::size(items);
  std::size_t place = 0;
  for (const auto& item : items) {
    if (++place > 1) text += place == count ? before_last : ", ";
    text += std::invoke(text_of, item);
  }
  return text;
}

/// Joins the texts of `items` with commas, as in "a, b, c".
template <typename Items, typename TextOf = std::identity>
[[nodiscard]] std::string with_commas(const Items& items, TextOf text_of = {}) {
  return enumerated(items, ", ", text_of);
}

}  // namespace softgrip
