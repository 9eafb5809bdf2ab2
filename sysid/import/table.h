#pragma once
// Columns of numbers from an external file of any format. A mapping assigns a role to the columns.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/time.h"
#include "document/problem.h"
#include "sysid/import/account.h"

namespace softgrip::sysid {

/// Bounds of an imported file, so that a small compressed file cannot exhaust the memory. Other commands read
/// logs of at most 512 MiB.
inline constexpr std::size_t most_text_bytes = std::size_t{512} << 20U;  ///< after decompression
inline constexpr std::size_t longest_line = std::size_t{1} << 20U;       ///< [bytes]; each byte can be a cell
inline constexpr std::size_t most_rows = std::size_t{1} << 24U;          ///< 4.6 h at 1 kHz
inline constexpr std::size_t most_values = std::size_t{1} << 27U;        ///< in all columns or arrays

/// A cell that is neither a number nor a word for a missing value.
struct BadCell {
  std::size_t row = 0;
  document::Location at;
  std::string line_text;
  std::string text;
  std::string cell{};  ///< name of the cell in a workbook ("B7"); empty for other files
};

struct TableColumn {
  std::string name;            ///< as written in the file; empty if the file does not name its columns
  std::string unit;            ///< from a row of units or an attribute, as written; empty: none
  std::vector<double> values;  ///< by row; NaN: missing value
  /// Number of values in the file that were dates or times of day. Each was converted to the time since the
  /// first of them [s].
  std::size_t moments = 0;
  Nanoseconds first_moment = 0;  ///< the first date or time of day, in the time scale of moments.h
  std::size_t short_clocks = 0;  ///< number of times with two fields ("12:34"), read as minutes and seconds
  /// Contains the nanoseconds that were added to another column (split_times.h).
  bool is_part_of_time = false;
  bool surely_minutes = false;  ///< one of the short clocks cannot be hours and minutes
  std::vector<BadCell> bad;     ///< the first few bad cells
  std::size_t bad_count = 0;
  std::vector<std::size_t> bad_rows;  ///< all rows with a bad cell; filled if bad lines are to be skipped
};

/// The columns of a file. All columns have the same number of values.
struct ForeignTable {
  std::string file;    ///< name of the file as the user gave it
  std::string format;  ///< in words: "CSV, ';' between columns, decimal comma"
  std::string sha256;  ///< hash of the file's bytes
  std::vector<TableColumn> columns;
  std::vector<int> line;  ///< line number of each row of a text; empty for a binary file
  std::vector<std::string>
      channels;                    ///< texts of the column of the fingers, in the order of their first rows
  std::string channel_column;      ///< name of the column of the fingers; empty: none, or topics are fingers
  std::vector<std::string> notes;  ///< skipped contents
  /// All rows of a text; for a binary file, only the rows that were left out.
  RowAccount account;
  bool is_text = false;
  bool has_rows_of_signals = false;        ///< each row contains the signal of one topic
  bool has_separators = false;             ///< the columns are separated by characters
  std::string sheet;                       ///< the sheet of a workbook that was read
  std::vector<std::size_t> missing_cells;  ///< number of cells for each word of TableOptions::missing

  [[nodiscard]] std::size_t rows() const noexcept {
    return columns.empty() ? 0 : columns.front().values.size();
  }
};

/// Options that decide how a file is interpreted where its content is not conclusive.
struct TableOptions {
  char separator = 0;  ///< 0: detected automatically
  std::vector<std::string>
      missing;          ///< words for a missing value, in addition to empty cells, NaN, NA and similar words
  std::string channel;  ///< read only the rows of this finger; empty: all rows
  bool skip_bad_lines = false;  ///< leave out lines with another number of cells, and count them
  std::string sheet{};          ///< sheet of a workbook; empty: the only sheet with numbers
};

/// Returns the index of the column that a word names: by its name, or by its number counted from 1 if no
/// column has this name. Returns the number of columns if there is no such column or the name is not unique.
[[nodiscard]] std::size_t column_index(const ForeignTable& table, std::string_view word);
/// Returns the word for a column in messages and options: its name, or its number if it has no unique name.
[[nodiscard]] std::string word_of(const ForeignTable& table, std::size_t index);

}  // namespace softgrip::sysid
