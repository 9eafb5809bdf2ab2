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
  const std::size_t count = std::size(items);
  std::size_t place = 0;
  for (const auto& item : items) {
    if (++place > 1) text += place == count ? before_last : ", ";
    text += std::invoke(text_of, item);
  }
  return text;
}

/// "a, b, c".
template <typename Items, typename TextOf = std::identity>
[[nodiscard]] std::string with_commas(const Items& items, TextOf text_of = {}) {
  return enumerated(items, ", ", text_of);
}

}  // namespace softgrip
