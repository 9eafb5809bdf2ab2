#pragma once
// Joins several texts into one, for messages.
// Describes errno values without allocating memory.
// Quotes words of a shell command line.

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstring>
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

/// Returns the description of an errno value from a constant table in the C library.
[[nodiscard]] inline const char* text_of_errno(int error) noexcept {
  const char* text = ::strerrordesc_np(error);
  return text != nullptr ? text : "unknown error";
}

/// Returns `text` in a form that a POSIX shell reads as one word. If no character of `text` is special in a
/// shell, the result is the unchanged text. Otherwise, the result is the text in single quotes.
[[nodiscard]] inline std::string shell_word(std::string_view text) {
  const bool plain = !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("_-./=:+,").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (plain) return std::string(text);
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace softgrip
