#pragma once
// Determines the format of a table in an external text: its separator, and the lines that contain names,
// units and numbers.
// Converts the character encoding of an external text to UTF-8.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "document/problem.h"
#include "sysid/import/table.h"
#include "sysid/logs/csv_text.h"

namespace softgrip::sysid {

/// A line with its number, counted from 1.
struct TextLine {
  int number = 0;
  std::string_view text;
  /// Number of empty lines between this line and the previous line of TextLines::content.
  int empty_above = 0;
};

/// The comments of a text (#, %, //), and the lines that are neither empty nor comments.
struct TextLines {
  std::vector<TextLine> content;
  std::vector<TextLine> comments;  ///< texts of the comments without the marks at their beginning
};
[[nodiscard]] TextLines text_lines(std::string_view text);

/// Splits a line into cells. Consecutive blanks count as one separator. Returns false if a quote is not
/// closed.
bool split_line(std::string_view line, char separator, std::vector<Cell>& cells);

/// Returns true if the cells of a line are a row of a table with `width` columns. At least one cell is a
/// number or a timestamp, and more than half of the cells contain a number, a timestamp or a missing value.
[[nodiscard]] bool is_row(const std::vector<Cell>& cells, std::size_t width, const TableOptions& options);

struct Dialect {
  char separator = ',';
  std::size_t first_row = 0;       ///< index of the first row of numbers in TextLines::content
  std::vector<std::string> names;  ///< column names; empty if the text has no names
  /// Units of the columns, from a row below the names; empty: the text has no row of units.
  std::vector<std::string> units;
  int names_line = 0;     ///< number of the line with the names; 0: the text has no names
  std::size_t width = 0;  ///< number of columns of the table
  /// True if each row ends with an empty cell that has no column name.
  bool extra_cell = false;
};

/// Returns true if a line below the first row contains the column names or the units of another table. The
/// line does not repeat the names or the units of this table. It has two or more different texts and no
/// number. Each column has a text, or one text is a column name of this table.
[[nodiscard]] bool begins_other_table(const std::vector<Cell>& cells, const Dialect& dialect,
                                      const TableOptions& options);
/// Returns true if the cells of a comment are the column names of the table in another order.
[[nodiscard]] bool reorders_names(const std::vector<Cell>& cells, const Dialect& dialect);

/// Detects the format from the rows of numbers. Adds a problem and returns nullopt if the text has no rows of
/// numbers, or if the number of names above the rows differs from the number of columns.
[[nodiscard]] std::optional<Dialect> dialect_of(const std::string& file, const TextLines& lines,
                                                const TableOptions& options, document::Problems& problems);

/// Converts a text to UTF-8 without a byte order mark. The line breaks of the result are "\n" or "\r\n".
/// Accepted encodings are UTF-8, UTF-16 and Latin-1. Without a byte order mark, UTF-16 is accepted only if
/// most of the first 32 characters are in Latin-1. If the bytes are not a text, returns a sentence that
/// describes the error.
[[nodiscard]] tl::expected<std::string, std::string> utf8_of(std::string_view bytes);

struct ForeignText {
  std::string text;  ///< text of the file, in UTF-8 as utf8_of() returns it
  /// Notes about NUL bytes that were removed at the end. A data logger leaves such bytes after a power
  /// failure.
  std::vector<std::string> notes;
};

/// Returns the text of an external file. The text may have at most most_text_bytes bytes and most_rows lines,
/// and each line at most longest_line bytes (table.h). If the text is refused, a problem is added.
[[nodiscard]] std::optional<ForeignText> foreign_text(const std::string& file, std::string_view bytes,
                                                      document::Problems& problems);

}  // namespace softgrip::sysid
