#pragma once
// Collects the arrays of a binary file and combines them into a table.

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Error message for an array that is refused, because the file would exceed most_values values with this
/// array.
inline constexpr const char* too_large = "with this array, the file has more than 134217728 values";

/// Collects the arrays of a file. The table contains only the arrays of one length, the most frequent length.
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
