#pragma once
// How a foreign table of text is written: what separates its columns, where names, units and numbers stand.

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

/// Splits a line; at blanks, several of them are one. False where a quote is not closed.
bool split_line(std::string_view line, char separator, std::vector<Cell>& cells);

struct Dialect {
  char separator = ',';
  std::size_t first_row = 0;       ///< among the lines of content
  std::vector<std::string> names;  ///< by column; empty where the text names none
  std::vector<std::string> units;  ///< by column, of a row below the names; empty: there is none
  int names_line = 0;              ///< 0: there are no names
  std::size_t width = 0;           ///< columns
  bool extra_cell = false;         ///< each row has one empty cell more than there are names
};

/// Finds it by the rows of numbers; nothing and a problem where there are none, or where the names above them
/// are not as many as the columns.
[[nodiscard]] std::optional<Dialect> dialect_of(const std::string& file, const TextLines& lines,
                                                const TableOptions& options, document::Problems& problems);

}  // namespace softgrip::sysid
