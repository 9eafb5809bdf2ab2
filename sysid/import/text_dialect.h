#pragma once
// Format of a table in an external text: its separator, and the lines of names, units and numbers.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "document/problem.h"
#include "sysid/import/table.h"
#include "sysid/logs/csv_text.h"

namespace softgrip::sysid {

/// A line with its number, counted from 1.
struct TextLine {
  int number = 0;
  std::string_view text;
};

/// The lines of a text that are neither empty nor comments (#, %, //), and the comments.
struct TextLines {
  std::vector<TextLine> content;
  std::vector<TextLine> comments;
};
[[nodiscard]] TextLines text_lines(std::string_view text);

/// Splits a line into cells. Several blanks count as one separator. Returns false if a quote is not closed.
bool split_line(std::string_view line, char separator, std::vector<Cell>& cells);

struct Dialect {
  char separator = ',';
  std::size_t first_row = 0;       ///< index of the first row of numbers in TextLines::content
  std::vector<std::string> names;  ///< by column; empty if the text has no names
  std::vector<std::string> units;  ///< by column, from a row below the names; empty: there is none
  int names_line = 0;              ///< number of the line with the names; 0: there are no names
  std::size_t width = 0;           ///< number of columns
  /// Each row has one more cell than there are names, and this last cell is empty.
  bool extra_cell = false;
};

/// Detects the format from the rows of numbers. Returns nullopt and adds a problem if there are no such rows,
/// or if the number of names above them differs from the number of columns.
[[nodiscard]] std::optional<Dialect> dialect_of(const std::string& file, const TextLines& lines,
                                                const TableOptions& options, document::Problems& problems);

}  // namespace softgrip::sysid
