#pragma once
// Defines tables and lists of terms for the results of commands, and writes them as text and as HTML.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace softgrip::result {

/// A table. For each column, `numeric` states whether the column is right-aligned. A column without an entry
/// in `numeric` is left-aligned.
struct Table {
  std::string caption;
  std::vector<std::string> header;
  std::vector<bool> numeric;
  std::vector<std::vector<std::string>> rows;
};

/// Returns the table as lines of text with aligned columns. The first line is the caption.
[[nodiscard]] std::string text_of(const Table& table);

/// A list of pairs: a term and its value.
using Terms = std::vector<std::pair<std::string, std::string>>;

/// Returns `text` with entities in place of & < > " ', and with a replacement character in place of each
/// control character. The result is safe as content and as a quoted attribute, for any `text`.
[[nodiscard]] std::string escaped(std::string_view text);

/// Returns an HTML element with the escaped text as its content, followed by a line break.
/// @param name  tag of the element; this text is not escaped.
[[nodiscard]] std::string element(std::string_view name, std::string_view text);

/// Returns the terms as a <dl> element. All texts are escaped.
[[nodiscard]] std::string html_of(const Terms& terms);
/// Returns the table as a <table> element in a <div> element of the class "scroll". The cells of a
/// right-aligned column have the class "n". All texts are escaped.
[[nodiscard]] std::string html_of(const Table& table);

}  // namespace softgrip::result
