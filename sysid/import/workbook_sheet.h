#pragma once
// Converts a workbook sheet to rows of text.
// Recognises the dates of a workbook by the number format of their cells, and writes them as text.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <chrono>
#include <pugixml.hpp>
#include <tl/expected.hpp>

#include "document/problem.h"

namespace softgrip::sysid {

/// Texts and number formats of the workbook. The cells of all sheets refer to them.
struct WorkbookTexts {
  std::vector<std::string> strings;  ///< texts that several cells can share
  /// For each style, true if numbers in this style are dates or times of day.
  std::vector<bool> date_styles;
  bool from_1904 = false;  ///< true: dates count from 1904 instead of 1900
};

struct SheetText {
  std::string text;              ///< CSV text; line N is row N of the sheet
  std::size_t first_column = 0;  ///< index of the first used column, counted from 0
  std::size_t first_row = 0;     ///< number of the first used row, counted from 1; 0: the sheet is empty
  std::size_t last_row = 0;
  std::size_t rows_of_numbers = 0;  ///< number of rows that contain at least 2 numbers
  std::vector<std::string> notes;
};

/// Reason why a sheet cannot be read, and its location.
struct SheetProblem {
  document::Location at;  ///< row and column, both counted from 1
  std::string message;
};

/// Returns the name of a cell, such as "B7". Rows are counted from 1 and columns from 0.
[[nodiscard]] std::string cell_name(std::size_t row, std::size_t column);

/// Returns the cells as lines of CSV. The table begins at the first row that has cells in at least 75 % of
/// the columns. The lines of the rows above the table have only as many cells as the sheet contains there.
/// From the table on, each row that is not empty has a cell for every column. Booleans are written as 1 and
/// 0, and dates in ISO 8601. If all dates of a column are below 1 day, they are written as times of day; rows
/// above the table have no influence on this choice. A formula gives its stored value. Errors and formulas
/// without a stored value give empty cells, and a note names these cells.
[[nodiscard]] tl::expected<SheetText, SheetProblem> sheet_text(const pugi::xml_document& sheet,
                                                               const WorkbookTexts& texts);

/// Returns true if a number in this format is a date or a time of day. Such formats are "yyyy-mm-dd" and
/// "[h]:mm:ss.000".
[[nodiscard]] bool is_date_format(std::string_view code);
[[nodiscard]] bool is_date_format(std::size_t builtin);

/// Returns a date in ISO 8601, or a time of day if `with_day` is false. Dates are rounded to 10 us, because
/// Excel stores them with a resolution of about 0.6 us. Times of day are rounded to 1 us.
/// @param serial  days since `from`.
[[nodiscard]] std::string iso_date(double serial, std::chrono::sys_days from, bool with_day);

}  // namespace softgrip::sysid
