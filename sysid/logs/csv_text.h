#pragma once
// Splits CSV text into lines, and lines into cells with their positions. The callers interpret the cells.

#include <string>
#include <string_view>
#include <vector>

namespace softgrip::sysid {

/// Returns the lines of a text, without their line breaks. Empty lines at the end of the text are omitted.
[[nodiscard]] std::vector<std::string_view> lines_of(std::string_view text);

/// A cell of a line, and the byte column at which the cell begins.
struct Cell {
  std::string_view text;
  int column;
};

/// Splits a line at separators outside double quotes. The cells keep their quotes. Returns false if a quote
/// is not closed.
bool split(std::string_view line, std::vector<Cell>& cells, char separator = ',');

/// Removes blanks at both ends of the text, and then one pair of double quotes.
[[nodiscard]] std::string_view unquoted(std::string_view text);

/// Returns the content of a cell without its quotes. Inside quotes, two successive quotes represent one quote
/// (RFC 4180).
[[nodiscard]] std::string cell_text(std::string_view cell);
/// Converts a text to a CSV cell. The cell is put in quotes if its content requires them.
[[nodiscard]] std::string as_cell(std::string_view text);

}  // namespace softgrip::sysid
