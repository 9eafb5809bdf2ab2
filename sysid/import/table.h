#pragma once
// Stores the columns of numbers of an external file in any format. A mapping assigns a role to each column
// that is used. The arrays of a binary file are combined into a table.

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/time.h"
#include "document/problem.h"
#include "sysid/import/account.h"

namespace softgrip::sysid {

/// Largest size of an imported text after decompression [bytes]. Without this limit and the limits below, a
/// small compressed file could exhaust the memory. Other commands read logs of at most 512 MiB.
inline constexpr std::size_t most_text_bytes = std::size_t{512} << 20U;
/// Largest length of a line [bytes]. This limit also bounds the number of cells in a line, because a cell has
/// at least one byte.
inline constexpr std::size_t longest_line = std::size_t{1} << 20U;
inline constexpr std::size_t most_rows = std::size_t{1} << 24U;  ///< largest number of rows; 4.6 h at 1 kHz
/// Largest number of values in all columns or arrays together.
inline constexpr std::size_t most_values = std::size_t{1} << 27U;

/// Value of a cell without a number.
inline constexpr double missing_value = std::numeric_limits<double>::quiet_NaN();

/// A cell that is neither a number nor a word for a missing value.
struct BadCell {
  std::size_t row = 0;
  document::Location at;
  std::string line_text;
  std::string text;
  std::string cell{};  ///< name of the cell in a workbook ("B7"); empty for other files
};

struct TableColumn {
  /// Name of the column in the file; empty if the file does not name its columns.
  std::string name;
  std::string unit;  ///< unit as written in a row of units or an attribute; empty: the file states no unit
  std::vector<double> values;  ///< value in each row; NaN: missing value
  /// Number of values that are dates or times of day in the file. Each of them was converted to the time
  /// since the first date or time of day [s].
  std::size_t moments = 0;
  Nanoseconds first_moment = 0;  ///< first date or time of day in the column, as Moment::time (moments.h)
  /// Number of times with two fields ("12:34"), which were read as minutes and seconds.
  std::size_t short_clocks = 0;
  /// True if the nanoseconds in this column were added to the times of another column (moments.h).
  bool is_part_of_time = false;
  bool surely_minutes = false;  ///< true: one of the times with two fields cannot be hours and minutes
  /// A cell such as "20,000" or "1.234", whose mark can be a decimal mark or separate thousands
  /// (cell_value.h); empty: the marks of this column have a clear meaning.
  std::string ambiguous_mark;
  std::vector<BadCell> bad;  ///< the first cells of the column that could not be read
  std::size_t bad_count = 0;
  /// All rows in which the cell of this column cannot be read. The list is filled only if the options request
  /// that such rows are skipped.
  std::vector<std::size_t> bad_rows;
};

/// The columns of a file. All columns have the same number of values.
struct ForeignTable {
  std::string file;    ///< name of the file as the user wrote it
  std::string format;  ///< name of the format: "CSV, ';' between columns, decimal comma"
  std::string sha256;  ///< SHA-256 of the bytes of the file
  std::vector<TableColumn> columns;
  std::vector<int> line;  ///< for each row of a text file, its line number; empty for a binary file
  /// For each row, its position in the file, counted from 0. Skipped lines count too, except lines of other
  /// fingers. Empty lines and rows in comments between two rows are skipped lines. Empty: no line was
  /// skipped, so the position is the index of the row.
  std::vector<std::size_t> position;
  std::vector<std::string>
      channels;  ///< names of the fingers in the column `channel_column`, in the order of their first rows
  /// Name of the column that identifies the finger of each row; empty: no column identifies the finger.
  std::string channel_column;
  std::vector<std::string> notes;     ///< notes about contents of the file that were skipped
  std::vector<std::string> warnings;  ///< warnings about contents that are damaged, or that may be damaged
  /// Row counts. For a text file, all rows are counted. For a binary file, only the left-out rows are
  /// counted.
  RowAccount account;
  bool is_text = false;
  bool has_rows_of_signals = false;  ///< true: each row contains the signal of one topic
  bool has_separators = false;       ///< true: a character separates the columns
  std::string sheet;                 ///< name of the workbook sheet that was read
  /// For each word of TableOptions::missing, the number of cells that contain it.
  std::vector<std::size_t> missing_cells;

  [[nodiscard]] std::size_t rows() const noexcept {
    return columns.empty() ? 0 : columns.front().values.size();
  }
};

/// Options that determine how a file is interpreted if its content is ambiguous.
struct TableOptions {
  char separator = 0;  ///< character between the columns; 0: detected automatically
  std::vector<std::string>
      missing;  ///< words that mean a missing value, in addition to an empty cell, NaN, NA and similar words
  std::string channel;          ///< name of the finger whose rows are read; empty: all rows are read
  bool skip_bad_lines = false;  ///< true: lines with a wrong number of cells are left out and counted
  std::string sheet{};          ///< name of the workbook sheet; empty: the only sheet that contains numbers
};

/// Returns the index of the column that a word names. The word is the name of the column or, if no column has
/// this name, the number of the column counted from 1. Returns the number of columns if there is no such
/// column or if several columns have this name.
[[nodiscard]] std::size_t column_index(const ForeignTable& table, std::string_view word);

/// Returns the number of cells with this value and the name of their column, such as "8 cells of 'tip (mm)'".
[[nodiscard]] std::string cells_with(const TableColumn& column, double value);
/// Returns the word that names a column in messages and options: its name or, if the name is missing or not
/// unique, its number.
[[nodiscard]] std::string word_of(const ForeignTable& table, std::size_t index);

/// Error message for an array that is refused, because the file would exceed most_values values with this
/// array.
inline constexpr const char* too_large = "with this array, the file has more than 134217728 values";

/// Collects the arrays of a file. The table contains only the arrays of one length: the length whose arrays
/// contain the most values, and at least two arrays. If two lengths have equally many values, the longer
/// arrays are used.
class ArrayCollector {
 public:
  explicit ArrayCollector(std::string file) : file_(std::move(file)) {}

  /// Adds an array with the values `values` in column-major order. A row or column vector becomes one column.
  /// Each column of a matrix becomes a column of the table, named "NAME(:,2)". If the matrix has more columns
  /// than rows, each row becomes a column of the table instead, named "NAME(2,:)". An array with fewer than
  /// two values is ignored. A matrix with more than 200 rows and more than 200 columns is skipped.
  void add(const std::string& name, const std::string& unit, std::size_t rows, std::size_t columns,
           const std::vector<double>& values);
  void note(std::string what) { notes_.push_back(std::move(what)); }
  /// Adds a note that the array `name` is skipped. The text `what` states the reason.
  void skip(const std::string& name, const std::string& what);
  /// Returns true if the file has at most most_values values after an array of this size is added. Call this
  /// function before the values are read.
  [[nodiscard]] bool has_room(std::size_t rows, std::size_t columns) const {
    return columns == 0 || rows <= (most_values - values_) / columns;
  }

  /// Returns the table. If no two arrays have the same length, adds a problem and returns nullopt.
  [[nodiscard]] std::optional<ForeignTable> table(const std::string& format,
                                                  document::Problems& problems) const;

 private:
  std::string file_;
  std::vector<TableColumn> columns_;
  std::vector<std::string> notes_;
  std::size_t values_ = 0;
};

}  // namespace softgrip::sysid
