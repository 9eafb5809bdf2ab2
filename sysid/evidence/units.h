#pragma once
// Divides repeated records into units for cross-validation. A model is fitted to all units except one, and
// then predicts this unit.

#include <cstddef>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

struct Division;

/// Division of a campaign into units. A unit is one run or, if there are many runs, several runs. If there is
/// a single run, its two halves are the units, although they do not show the differences between runs.
class Units {
 public:
  Units() = default;
  /// @param records  at least one record, each with at least one sample.
  explicit Units(const std::vector<Record>& records);

  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] std::size_t runs() const noexcept { return middle_s_.size(); }
  [[nodiscard]] bool are_runs() const noexcept { return runs() > 1; }
  /// Returns the index of the unit to which a sample of a record belongs.
  /// @param since_start_s  time of the sample since the first sample of the record.
  [[nodiscard]] std::size_t unit_of(std::size_t record, double since_start_s) const noexcept;
  /// Returns the records with the readings of one unit replaced by NaN. A record that belongs to the unit
  /// completely is omitted.
  /// @param unit  if it equals count(), nothing is omitted.
  /// @param kept  receives the index of each returned record; may be nullptr.
  [[nodiscard]] std::vector<Record> without(const std::vector<Record>& records, std::size_t unit,
                                            std::vector<std::size_t>* kept = nullptr) const;

 private:
  std::size_t count_ = 0;
  std::vector<double> middle_s_;  ///< for each record, the time from its start to its middle
};

/// Divides the records into blocks of limits::block_s seconds. All blocks of a unit are in the same fold.
[[nodiscard]] Division divide_by_unit(const std::vector<Record>& records);

}  // namespace softgrip::sysid
