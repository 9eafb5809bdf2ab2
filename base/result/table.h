#pragma once
// Tables and lists of terms of a result, and their text. html.h writes them as HTML.

#include <string>
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

/// Terms and the value of each term.
using Terms = std::vector<std::pair<std::string, std::string>>;

}  // namespace softgrip::result
