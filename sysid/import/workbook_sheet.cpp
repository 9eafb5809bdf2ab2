#include "sysid/import/workbook_sheet.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>

#include "base/numbers.h"
#include "sysid/import/cell_value.h"
#include "sysid/import/table.h"
#include "sysid/import/units.h"
#include "sysid/import/workbook_package.h"
#include "sysid/logs/csv_text.h"

namespace softgrip::sysid {
namespace {

// Largest numbers of rows and columns that the file format allows in a sheet.
constexpr std::size_t most_sheet_rows = 1048576;
constexpr std::size_t most_sheet_columns = 16384;
constexpr std::size_t cells_named = 5;

enum class Content : std::uint8_t { none, number, date, text, error, no_value };

struct SheetCell {
  std::size_t row = 0;     ///< number of the row, counted from 1
  std::size_t column = 0;  ///< index of the column, counted from 0
  Content content = Content::none;
  std::string text;      ///< text, number as written in the file, or code of an error
  double serial = 0;     ///< value of a date, in days since the origin of the calendar
  bool formula = false;  ///< true: the cell contains a formula; its value is the stored result
  bool is_bool = false;
};

/// Number of cells that were added, and the names of the first of these cells.
struct NamedCells {
  std::size_t count = 0;
  std::string names;

  void add(const std::string& name) {
    if (++count <= cells_named) names += (names.empty() ? "" : ", ") + name;
  }
  [[nodiscard]] std::string list() const { return names + (count > cells_named ? ", ..." : ""); }
};

std::string column_letters(std::size_t column) {
  std::string text;
  for (std::size_t left = column + 1; left > 0; left = (left - 1) / 26)
    text.insert(text.begin(), static_cast<char>('A' + (left - 1) % 26));
  return text;
}

/// Converts a text to a row number; returns nullopt if the text is not a valid row number.
std::optional<std::size_t> row_number(std::string_view text) {
  const auto row = whole_number(text);
  return row && *row >= 1 && *row <= most_sheet_rows ? row : std::nullopt;
}

/// The row and the column of a cell.
struct Place {
  std::size_t row = 0;
  std::size_t column = 0;
};
std::optional<Place> place_of(std::string_view reference) {
  Place place;
  std::size_t letters = 0;
  while (letters < reference.size() && reference[letters] >= 'A' && reference[letters] <= 'Z' && letters < 4)
    place.column = 26 * place.column + static_cast<std::size_t>(reference[letters++] - 'A' + 1);
  const auto row = row_number(reference.substr(letters));
  if (letters == 0 || !row || place.column > most_sheet_columns) return std::nullopt;
  return Place{*row, place.column - 1};
}

/// Returns a text as a cell of CSV. A text that begins like a comment is put in quotes, so that the reader of
/// the CSV does not skip its line as a comment.
std::string csv_cell(std::string text) {
  for (char& c : text) c = c == '\n' || c == '\r' || c == '\t' ? ' ' : c;
  const bool like_comment = !text.empty() && (text[0] == '#' || text[0] == '%' || text[0] == '/');
  return like_comment && as_cell(text) == text ? '"' + text + '"' : as_cell(text);
}

class SheetReader {
 public:
  SheetReader(const pugi::xml_document& sheet, const WorkbookTexts& texts)
      : root_(sheet.document_element()), data_(child_of(root_, "sheetData")), texts_(texts) {}

  tl::expected<SheetText, SheetProblem> read() {
    if (local_name(root_.name()) != "worksheet") fail({1, 1}, "the XML of the sheet is not a worksheet");
    walk([this](const SheetCell& cell) { survey(cell); });
    full_row_ = first_full_row();
    if (dates_ > 0) walk([this](const SheetCell& cell) { survey_date(cell); });
    if (!problem_) write();
    if (problem_) return tl::unexpected(*problem_);
    name_what_differs();
    return std::move(result_);
  }

 private:
  void fail(document::Location at, std::string message) {
    if (!problem_) problem_ = SheetProblem{at, std::move(message)};
  }

  /// Calls `take` for each cell that has content, in the order of rows and columns.
  template <class Take>
  void walk(const Take& take) {
    std::size_t row = 0;
    shared_bytes_ = 0;
    for (const pugi::xml_node& node : data_.children()) {
      if (problem_) return;
      if (local_name(node.name()) != "row") continue;
      const std::size_t before = row++;
      if (const std::string_view number = attribute_of(node, "r"); !number.empty()) {
        const auto said = row_number(number);
        if (!said || *said <= before)
          return fail({static_cast<int>(before + 1), 1},
                      "a row has the number '" + document::shown(number) + "', but a number above " +
                          std::to_string(before) + " and at most " + std::to_string(most_sheet_rows) +
                          " is expected");
        row = *said;
      }
      walk_row(node, row, take);
    }
  }

  template <class Take>
  void walk_row(const pugi::xml_node& node, std::size_t row, const Take& take) {
    std::size_t next = 0;
    for (const pugi::xml_node& child : node.children()) {
      if (local_name(child.name()) != "c") continue;
      SheetCell cell;
      cell.row = row;
      cell.column = next;
      if (const std::string_view name = attribute_of(child, "r"); !name.empty()) {
        const auto at = place_of(name);
        if (!at || at->row != row || at->column < next)
          return fail({static_cast<int>(row), static_cast<int>(next + 1)},
                      "row " + std::to_string(row) + " has a cell '" + document::shown(name) + "' where " +
                          cell_name(row, next) + " or a cell to the right of this cell is expected");
        cell.column = at->column;
      }
      if (cell.column >= most_sheet_columns)
        return fail({static_cast<int>(row), 1}, "row " + std::to_string(row) + " has more than " +
                                                    std::to_string(most_sheet_columns) + " columns");
      next = cell.column + 1;
      fill(child, cell);
      if (problem_) return;
      if (cell.content != Content::none) take(cell);
    }
  }

  void refuse_cell(const SheetCell& cell, const std::string& message) {
    fail({static_cast<int>(cell.row), static_cast<int>(cell.column + 1)},
         "cell " + cell_name(cell.row, cell.column) + ": " + message);
  }

  void fill(const pugi::xml_node& node, SheetCell& cell) {
    const std::string_view type = attribute_of(node, "t");
    const pugi::xml_node value = child_of(node, "v");
    cell.text = type == "inlineStr" ? string_in(child_of(node, "is")) : value.child_value();
    const bool has_formula = !child_of(node, "f").empty();
    const bool stored = !value.empty() && (type == "str" || !trimmed(cell.text).empty());
    if (has_formula && !stored && type != "inlineStr") {
      cell.content = Content::no_value;
      return;
    }
    cell.formula = has_formula;
    if (trimmed(cell.text).empty()) return;
    if (type.empty() || type == "n") return fill_number(node, cell);
    if (type == "s") return fill_shared(cell);
    if (type == "b") return fill_boolean(cell);
    if (type != "str" && type != "inlineStr" && type != "e" && type != "d")
      return refuse_cell(cell,
                         "its type '" + document::shown(type) + "' is none of b, d, e, inlineStr, n, s, str");
    cell.content = type == "e" ? Content::error : Content::text;
  }

  void fill_number(const pugi::xml_node& node, SheetCell& cell) {
    cell.text = std::string(trimmed(cell.text));
    const auto number = to_number(cell.text);
    if (!number)
      return refuse_cell(cell, "'" + document::shown(cell.text) +
                                   "' is not a number, although the file declares this cell as a number");
    if (!std::isfinite(*number)) {
      cell.content = Content::text;  // the reader of text tables interprets "NaN" when it reads the CSV
      return;
    }
    cell.content = Content::number;
    const std::string_view style = attribute_of(node, "s");
    if (style.empty() || texts_.date_styles.empty()) return;
    const auto index = whole_number(style);
    if (!index || *index >= texts_.date_styles.size())
      return refuse_cell(cell, "style '" + document::shown(style) + "' is none of the " +
                                   std::to_string(texts_.date_styles.size()) + " of the workbook");
    if (!texts_.date_styles[*index]) return;
    constexpr double most_days = 2958466;  // number of the last day of the year 9999
    if (*number < 0 || *number >= most_days)
      return refuse_cell(
          cell, "'" + document::shown(cell.text) + "' is not a date, although its format is that of a date");
    cell.content = Content::date;
    cell.serial = *number;
  }

  void fill_shared(SheetCell& cell) {
    const auto index = whole_number(trimmed(cell.text));
    if (!index || *index >= texts_.strings.size())
      return refuse_cell(cell, "shared string '" + document::shown(cell.text) + "' is none of the " +
                                   std::to_string(texts_.strings.size()) + " of the workbook");
    // The size of a text is added once for each cell that refers to this text, because many cells can refer
    // to one long text.
    shared_bytes_ += texts_.strings[*index].size();
    if (shared_bytes_ > most_text_bytes)
      return refuse_cell(cell,
                         "the sheet has more than " + std::to_string(most_text_bytes) + " bytes of text");
    cell.text = texts_.strings[*index];
    if (!trimmed(cell.text).empty()) cell.content = Content::text;
  }

  void fill_boolean(SheetCell& cell) {
    cell.text = std::string(trimmed(cell.text));
    if (cell.text == "true") cell.text = "1";
    if (cell.text == "false") cell.text = "0";
    if (cell.text != "1" && cell.text != "0")
      return refuse_cell(cell, "'" + document::shown(cell.text) + "' is not a boolean: 0 or 1 is expected");
    cell.is_bool = true;
    cell.content = Content::number;
  }

  /// Extends the range of used rows and columns by a cell. Call this function for all cells before the first
  /// cell is written.
  void survey(const SheetCell& cell) {
    if (result_.first_row == 0) {
      result_.first_row = cell.row;
      first_column_ = last_column_ = cell.column;
    }
    if (result_.last_row != cell.row) {
      numbers_ = 0;
      filled_.push_back({cell.row, 0});
    }
    result_.last_row = cell.row;
    first_column_ = std::min(first_column_, cell.column);
    last_column_ = std::max(last_column_, cell.column);
    ++filled_.back().second;
    const bool number = cell.content == Content::number || cell.content == Content::date;
    if (number && ++numbers_ == 2) ++result_.rows_of_numbers;
    dates_ += cell.content == Content::date ? 1 : 0;
    const std::string name = cell_name(cell.row, cell.column);
    if (cell.content == Content::error) errors_.add(name + " (" + document::shown(cell.text, 20) + ")");
    if (cell.content == Content::no_value) no_values_.add(name);
    formulas_ += cell.formula ? 1 : 0;
    booleans_ += cell.is_bool ? 1 : 0;
  }

  /// Updates the latest date in the column of a cell. Dates above the table are ignored.
  void survey_date(const SheetCell& cell) {
    if (cell.content == Content::date && cell.row >= full_row_)
      longest_[cell.column] = std::max(longest_[cell.column], cell.serial);
  }

  /// Returns the first row that has cells in at least 75 % of the columns. A title above the table usually
  /// has fewer cells.
  [[nodiscard]] std::size_t first_full_row() const {
    const std::size_t width = last_column_ - first_column_ + 1;
    const auto full = std::find_if(filled_.begin(), filled_.end(),
                                   [&](const auto& row) { return 4 * row.second >= 3 * width; });
    return full == filled_.end() ? result_.first_row : full->first;
  }

  [[nodiscard]] std::string written(const SheetCell& cell) {
    if (cell.content == Content::number) return cell.text;
    if (cell.content == Content::text) return csv_cell(cell.text);
    if (cell.content != Content::date) return {};
    using namespace std::chrono;
    constexpr sys_days of_1900{year{1899} / 12 / 30};
    constexpr sys_days of_1904{year{1904} / 1 / 1};
    constexpr double a_year = 366;
    const double longest = cell.row < full_row_ ? cell.serial : longest_[cell.column];
    // If all values of a column are below one year, they are durations. The origin of the calendar must not
    // change their text, so it is always 1904.
    return iso_date(cell.serial, texts_.from_1904 || longest < a_year ? of_1904 : of_1900, longest >= 1);
  }

  void write() {
    if (result_.first_row == 0) return;
    std::size_t row = result_.first_row;
    std::size_t column = first_column_;
    std::string& text = result_.text;
    text.assign(row - 1, '\n');
    const auto end_row = [&] {
      if (row >= full_row_) text.append(last_column_ - column, ',');
    };
    walk([&](const SheetCell& cell) {
      if (cell.row != row) {
        end_row();
        text.append(cell.row - row, '\n');
        row = cell.row;
        column = first_column_;
      }
      text.append(cell.column - column, ',');
      column = cell.column;
      text += written(cell);
      if (text.size() > most_text_bytes)
        fail({static_cast<int>(row), 1},
             "the text of the sheet has more than " + std::to_string(most_text_bytes) + " bytes");
    });
    end_row();
    text += '\n';
  }

  /// Adds a note with a description, a number of cells and their names: "what (3): where".
  void note(const std::string& what, std::size_t count, const std::string& where = {}) {
    result_.notes.push_back(what + " (" + std::to_string(count) + ")" + (where.empty() ? "" : ": " + where));
  }

  void name_what_differs() {
    result_.first_column = first_column_;
    if (result_.first_row > 0 && first_column_ > 0)
      result_.notes.push_back("column 1 is column " + column_letters(first_column_) + " of the sheet");
    if (errors_.count > 0) note("cells with an error are missing values", errors_.count, errors_.list());
    if (no_values_.count > 0)
      note("formulas without a stored value are missing values", no_values_.count, no_values_.list());
    if (formulas_ > 0) note("the stored values of formulas are used", formulas_);
    if (booleans_ > 0) note("booleans are used as 1 and 0", booleans_);
    if (dates_ > 0)
      note(texts_.from_1904 ? "cells with dates or times, counted from 1904" : "cells with dates or times",
           dates_);
    const std::size_t span = result_.first_row == 0 ? 0 : result_.last_row - result_.first_row + 1;
    if (span > filled_.size()) note("empty rows between other rows are skipped", span - filled_.size());
    name_hidden();
    NamedCells merged;
    for (const pugi::xml_node& merge : child_of(root_, "mergeCells").children())
      merged.add(document::shown(attribute_of(merge, "ref"), 20));
    if (merged.count > 0)
      note("of merged cells, only the first cell has the value", merged.count, merged.list());
  }

  void name_hidden() {
    const auto count = [](const pugi::xml_node& parent) {
      std::size_t hidden = 0;
      for (const pugi::xml_node& child : parent.children()) {
        const std::string_view said = attribute_of(child, "hidden");
        if (is_true(said)) ++hidden;
      }
      return hidden;
    };
    if (const std::size_t rows = count(data_); rows > 0) note("hidden rows are read like visible rows", rows);
    if (const std::size_t columns = count(child_of(root_, "cols")); columns > 0)
      note("hidden columns are read like visible columns", columns);
  }

  pugi::xml_node root_;
  pugi::xml_node data_;
  const WorkbookTexts& texts_;
  SheetText result_;
  std::optional<SheetProblem> problem_;
  std::size_t first_column_ = 0;
  std::size_t last_column_ = 0;
  std::vector<std::pair<std::size_t, std::size_t>>
      filled_;                    ///< for each row with content: row number and number of cells
  std::size_t full_row_ = 0;      ///< number of the first row below the titles
  std::size_t shared_bytes_ = 0;  ///< total size of the shared strings to which the cells refer [bytes]
  std::map<std::size_t, double> longest_;  ///< for each column: latest date below the titles
  std::size_t numbers_ = 0;                ///< number of cells with a number in the current row
  std::size_t dates_ = 0;
  std::size_t formulas_ = 0;
  std::size_t booleans_ = 0;
  NamedCells errors_;
  NamedCells no_values_;
};

}  // namespace

std::string cell_name(std::size_t row, std::size_t column) {
  return column_letters(column) + std::to_string(row);
}

tl::expected<SheetText, SheetProblem> sheet_text(const pugi::xml_document& sheet,
                                                 const WorkbookTexts& texts) {
  return SheetReader(sheet, texts).read();
}

}  // namespace softgrip::sysid
