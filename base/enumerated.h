#pragma once
// Several texts as one, for people.

#include <cstddef>
#include <functional>
#include <iterator>
#include <string>
#include <string_view>

namespace softgrip {

/// "a, b and c" with " and " before the last: the texts of `items` in their order; "" of none. `text_of`
/// makes a std::string or a view of one out of an item, or is the member that holds it.
template <typename Items, typename TextOf = std::identity>
[[nodiscard]] std::string enumerated(const Items& items, std::string_view before_last, TextOf text_of = {}) {
  std::string text;
  std::size_t left = std::size(items);
  for (const auto& item : items) {
    if (!text.empty()) text += left == 1 ? before_last : ", ";
    text += std::invoke(text_of, item);
    --left;
  }
  return text;
}

/// "a, b, c".
template <typename Items, typename TextOf = std::identity>
[[nodiscard]] std::string with_commas(const Items& items, TextOf text_of = {}) {
  return enumerated(items, ", ", text_of);
}

}  // namespace softgrip
