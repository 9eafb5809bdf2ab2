#pragma once
// Conversion of a workbook sheet to rows of text.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>
#include <tl/expected.hpp>

#include "document/problem.h"

namespace softgrip::sysid {

/// Texts and formats to which the cells of all sheets refer.
struct WorkbookTexts {
  std::vector<std::string> strings;  ///< shared strings
  std::vector<bool> date_styles;     ///< by style; true: numbers in this style are dates or times of day
  bool from_1904 = false;            ///< dates count from 1904
};

struct SheetText {
  std::string text;              ///< line N is row N of the sheet; commas between the cells
  std::size_t first_column = 0;  ///< counted from 0
  std::size_t first_row = 0;     ///< counted from 1; 0: the sheet is empty
  std::size_t last_row = 0;
  std::size_t rows_of_numbers = 0;  ///< rows with 2 numbers or more
  std::vector<std::string> notes;
};

/// The reason why a sheet cannot be read.
struct SheetProblem {
  document::Location at;  ///< row and column, both from 1
  std::string message;
};

/// Returns true if numbers in this format are dates or times of day: "yyyy-mm-dd", "[h]:mm:ss.000".
[[nodiscard]] bool is_date_format(std::string_view code);
[[nodiscard]] bool is_date_format(std::size_t builtin);

/// Returns the name of a cell, such as "B7". Rows are counted from 1 and columns from 0.
[[nodiscard]] std::string cell_name(std::size_t row, std::size_t column);

/// Returns the cells as lines of CSV. The first row that has at least 75 % of the columns begins the table.
/// Rows above it contain only their own cells. From this row on, each row that is not empty has all columns.
/// Booleans are written as 1 and 0, and dates as ISO 8601. A column whose values are all within one day is
/// written as times of day, regardless of the rows above the table. A formula gives its stored value. Errors
/// and formulas without a stored value give empty cells, and a note names these cells.
[[nodiscard]] tl::expected<SheetText, SheetProblem> sheet_text(const pugi::xml_document& sheet,
                                                               const WorkbookTexts& texts);

}  // namespace softgrip::sysid
