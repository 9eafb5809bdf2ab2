#pragma once
// A foreign file as columns of numbers, whatever its format was; what they mean is the mapping's business.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/time.h"
#include "document/problem.h"
#include "sysid/import/account.h"

namespace softgrip::sysid {

/// Bounds of a foreign file, so that a small file cannot exhaust the memory. A log of 512 MiB is the longest
/// that other commands read.
inline constexpr std::size_t most_text_bytes = std::size_t{512} << 20U;  ///< after decompression
inline constexpr std::size_t longest_line = std::size_t{1} << 20U;       ///< [bytes]; each can be a cell
inline constexpr std::size_t most_rows = std::size_t{1} << 24U;          ///< 4.6 h at 1 kHz
inline constexpr std::size_t most_values = std::size_t{1} << 27U;        ///< in all columns or arrays

/// A cell that is neither a number nor a word for none.
struct BadCell {
  std::size_t row = 0;
  document::Location at;
  std::string line_text;
  std::string text;
  std::string cell{};  ///< its name in a workbook ("B7"); empty elsewhere
};

struct TableColumn {
  std::string name;            ///< as the file has it; empty where it names no columns
  std::string unit;            ///< of a row of units or an attribute, as written; empty: none
  std::vector<double> values;  ///< by row; NaN: nothing was there
  /// How many of them were dates or times of day; their values are seconds after the first of these.
  std::size_t moments = 0;
  Nanoseconds first_moment = 0;  ///< of these, on the scale of moments.h
  std::size_t short_clocks = 0;  ///< how many of them have two fields ("12:34"), read as minutes and seconds
  bool is_part_of_time = false;  ///< nanoseconds that another column contains (split_times.h)
  bool surely_minutes = false;   ///< one of the short clocks cannot be hours and minutes
  std::vector<BadCell> bad;      ///< the first few
  std::size_t bad_count = 0;
  std::vector<std::size_t> bad_rows;  ///< all of them, where bad lines are to be skipped
};

/// All columns are equally long.
struct ForeignTable {
  std::string file;    ///< as the user named it
  std::string format;  ///< in words: "CSV, ';' between columns, decimal comma"
  std::string sha256;  ///< of the file's bytes
  std::vector<TableColumn> columns;
  std::vector<int> line;  ///< of each row in the text; empty of a binary file
  std::vector<std::string>
      channels;                    ///< texts of the column of the fingers, in the order of their first rows
  std::string channel_column;      ///< its name; empty: there is none, or topics stand for it
  std::vector<std::string> notes;  ///< what was passed over
  RowAccount account;              ///< of a text's rows, but of a binary file's only those left out
  bool is_text = false;
  bool has_rows_of_signals = false;        ///< each row has the signal of one topic
  bool has_separators = false;             ///< characters between the columns
  std::string sheet;                       ///< of a workbook, the one that was read
  std::vector<std::size_t> missing_cells;  ///< for each word of TableOptions::missing: the cells that say it

  [[nodiscard]] std::size_t rows() const noexcept {
    return columns.empty() ? 0 : columns.front().values.size();
  }
};

/// How a text is to be understood where it cannot be seen.
struct TableOptions {
  char separator = 0;  ///< 0: found
  std::vector<std::string>
      missing;          ///< what stands where nothing was read, besides empty cells, NaN, NA and the like
  std::string channel;  ///< only rows whose column of the fingers says this; empty: all
  bool skip_bad_lines = false;  ///< leave out lines of another width, and count them
  std::string sheet{};          ///< of a workbook; empty: the only one with numbers
};

/// The column that a word names: its name, or its number counted from 1 where no name is that. Its index, or
/// the number of columns where there is none or more than one of the name.
[[nodiscard]] std::size_t column_index(const ForeignTable& table, std::string_view word);
/// How a column is named in messages and options: its name, or its number where it has none of its own.
[[nodiscard]] std::string word_of(const ForeignTable& table, std::size_t index);

}  // namespace softgrip::sysid
