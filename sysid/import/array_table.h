#pragma once
// Collects the arrays of a binary file and makes a table of them.

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Error message about an array with which the file would exceed most_values.
inline constexpr const char* too_large = "with this array, the file has more than 134217728 values";

/// Collects the arrays of a file. The table contains the arrays that have the most frequent length.
class ArrayCollector {
 public:
  explicit ArrayCollector(std::string file) : file_(std::move(file)) {}

  /// Adds an array. A row or column vector becomes one column. A matrix becomes one column for each of its
  /// columns, named "NAME(:,2)". If it has more columns than rows, each of its rows becomes a column, named
  /// "NAME(2,:)". `values` are in column-major order. An array with fewer than two values is ignored.
  void add(const std::string& name, const std::string& unit, std::size_t rows, std::size_t columns,
           const std::vector<double>& values);
  void note(std::string what) { notes_.push_back(std::move(what)); }
  /// Adds a note that the array `name` is skipped. `what` states the reason.
  void pass_over(const std::string& name, const std::string& what);
  /// Returns true if an array of this size still fits within most_values. Call it before the values are read.
  [[nodiscard]] bool has_room(std::size_t rows, std::size_t columns) const {
    return columns == 0 || rows <= (most_values - values_) / columns;
  }

  /// Returns the table. Returns nullopt and adds a problem if no two arrays have the same length.
  [[nodiscard]] std::optional<ForeignTable> table(const std::string& format,
                                                  document::Problems& problems) const;

 private:
  std::string file_;
  std::vector<TableColumn> columns_;
  std::vector<std::string> notes_;
  std::size_t values_ = 0;
};

}  // namespace softgrip::sysid
