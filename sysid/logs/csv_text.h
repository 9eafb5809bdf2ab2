#pragma once
// CSV as text: lines and cells with their places. The readers interpret them.

#include <string>
#include <string_view>
#include <vector>

namespace softgrip::sysid {

/// The text, line by line, without line breaks; without the empty lines at its end.
[[nodiscard]] std::vector<std::string_view> lines_of(std::string_view text);

/// A cell and the byte column at which it begins.
struct Cell {
  std::string_view text;
  int column;
};

/// Splits at separators outside double quotes. The cells keep their quotes. False where a quote is not
/// closed.
bool split(std::string_view line, std::vector<Cell>& cells, char separator = ',');

/// Without the blanks around it, and without the double quotes around that.
[[nodiscard]] std::string_view unquoted(std::string_view text);

/// Returns the content of a cell: unquoted, and inside quotes two of them stand for one (RFC 4180).
[[nodiscard]] std::string cell_text(std::string_view cell);
/// The cell that says it: in quotes where it must be.
[[nodiscard]] std::string as_cell(std::string_view text);

}  // namespace softgrip::sysid
