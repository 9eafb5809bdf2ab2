#pragma once
// Splits CSV text into lines, and lines into cells with their positions. The callers interpret the cells.

#include <cstddef>
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

/// Detects a text that may be cut off inside its last cell.
class CutOffDetector {
 public:
  /// Adds a row. `line` must be a part of the text.
  void add(std::string_view line, std::string_view last_cell);
  /// Returns true if no line break follows the last row, and the last cell of this row is shorter than the
  /// last cells of all other rows. At least two other rows are required.
  [[nodiscard]] bool may_be_cut_off(std::string_view text) const;

 private:
  std::string_view last_line_;
  std::size_t last_length_ = 0;
  std::size_t shortest_before_ = static_cast<std::size_t>(-1);
  std::size_t rows_ = 0;
};

/// Returns a sentence about the last row of a text for which CutOffDetector::may_be_cut_off() is true.
[[nodiscard]] std::string cut_off_sentence(std::string_view last_cell);

/// Returns a sentence about a last line that has too few cells.
[[nodiscard]] std::string left_out_sentence(std::size_t line);

/// Removes blanks at both ends of the text, and then one pair of double quotes.
[[nodiscard]] std::string_view unquoted(std::string_view text);

/// Returns the content of a cell without its quotes. Inside quotes, two successive quotes represent one quote
/// (RFC 4180).
[[nodiscard]] std::string cell_text(std::string_view cell);
/// Converts a text to a CSV cell. The cell is put in quotes if its content requires them.
[[nodiscard]] std::string as_cell(std::string_view text);

}  // namespace softgrip::sysid
