#pragma once
// Arrays of a binary file, gathered into a table.

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// What is said of an array that does not fit within most_values.
inline constexpr const char* too_large = "with it the file has more than 134217728 values";

/// Collects the arrays of a file and keeps those that are as long as most others.
class ArrayCollector {
 public:
  explicit ArrayCollector(std::string file) : file_(std::move(file)) {}

  /// A vector, whichever way it lies, as one column; a matrix as its columns, named "NAME(:,2)", or, where it
  /// lies, as its rows. `values` are by columns (Fortran's order). What has fewer than two values is passed
  /// over.
  void add(const std::string& name, const std::string& unit, std::size_t rows, std::size_t columns,
           const std::vector<double>& values);
  void note(std::string what) { notes_.push_back(std::move(what)); }
  /// Something in the file that is no array of numbers.
  void pass_over(const std::string& name, const std::string& what);
  /// True if an array of this size still fits within most_values. Ask before its values are read.
  [[nodiscard]] bool has_room(std::size_t rows, std::size_t columns) const {
    return columns == 0 || rows <= (most_values - values_) / columns;
  }

  /// The table, or a problem where there is none.
  [[nodiscard]] std::optional<ForeignTable> table(const std::string& format,
                                                  document::Problems& problems) const;

 private:
  std::string file_;
  std::vector<TableColumn> columns_;
  std::vector<std::string> notes_;
  std::size_t values_ = 0;
};

}  // namespace softgrip::sysid
