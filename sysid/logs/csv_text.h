#pragma once
// Splits CSV into lines and into cells with their positions. The callers interpret the cells.

#include <string>
#include <string_view>
#include <vector>

namespace softgrip::sysid {

/// Returns the lines of a text without line breaks. Empty lines at the end are omitted.
[[nodiscard]] std::vector<std::string_view> lines_of(std::string_view text);

/// A cell and the byte column at which it begins.
struct Cell {
  std::string_view text;
  int column;
};

/// Splits a line at separators outside double quotes. The cells keep their quotes. Returns false if a quote
/// is not closed.
bool split(std::string_view line, std::vector<Cell>& cells, char separator = ',');

/// Removes blanks at both ends, and then a pair of double quotes.
[[nodiscard]] std::string_view unquoted(std::string_view text);

/// Returns the content of a cell without its quotes. Inside quotes, two successive quotes represent one quote
/// (RFC 4180).
[[nodiscard]] std::string cell_text(std::string_view cell);
/// Returns a cell with the given content, in quotes if necessary.
[[nodiscard]] std::string as_cell(std::string_view text);

}  // namespace softgrip::sysid
