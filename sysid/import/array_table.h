#pragma once
// Arrays of a binary file, gathered into a table.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "document/problem.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// A binary file holds no more than this in all its arrays.
inline constexpr std::size_t most_values = std::size_t{1} << 27;

/// Collects the arrays of a file and keeps those that are as long as most others.
class ArrayCollector {
 public:
  explicit ArrayCollector(std::string file) : file_(std::move(file)) {}

  /// A vector, whichever way it lies, as one column; a matrix as its columns, named "NAME(:,2)", or, where it
  /// lies, as its rows. `values` are by columns (Fortran's order). What has fewer than two values is passed
  /// over.
  void add(const std::string& name, const std::string& unit, std::size_t rows, std::size_t columns,
           const std::vector<double>& values);
  /// Something in the file that is no array of numbers.
  void pass_over(const std::string& name, const std::string& what);
  /// True when the file holds more than can be meant.
  [[nodiscard]] bool full() const { return values_ > most_values; }

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
