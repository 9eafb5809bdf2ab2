#pragma once
// Divides records of repeated runs into units for cross-validation. A model is fitted to all units except
// one, and then predicts the unit that was left out.

#include <cstddef>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

struct Division;

/// Division of repeated runs into units. A unit is one run. If there are more than limits::most_units runs,
/// units consist of several runs. A single run is divided into two halves, which are then the units. The
/// halves do not show the differences between runs.
class Units {
 public:
  Units() = default;
  /// @param records  at least one record, each with at least one sample.
  explicit Units(const std::vector<Record>& records);

  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] std::size_t runs() const noexcept { return middle_s_.size(); }
  [[nodiscard]] bool are_runs() const noexcept { return runs() > 1; }
  /// Returns the length of the blocks that a bootstrap resamples within a unit [s].
  [[nodiscard]] double block_s() const noexcept { return block_s_; }
  /// Returns the index of the unit that contains a sample of a record.
  /// @param since_start_s  time from the first sample of the record to this sample.
  [[nodiscard]] std::size_t unit_of(std::size_t record, double since_start_s) const noexcept;
  /// Returns the records without the readings of one unit. If the unit contains a complete record, this
  /// record is omitted. Otherwise, the readings of the unit are replaced by NaN.
  /// @param unit  unit that is left out; if it equals count(), nothing is left out.
  /// @param kept  receives the index of each returned record; may be nullptr.
  [[nodiscard]] std::vector<Record> without(const std::vector<Record>& records, std::size_t unit,
                                            std::vector<std::size_t>* kept = nullptr) const;

 private:
  std::size_t count_ = 0;
  double block_s_ = 0;
  std::vector<double> middle_s_;  ///< for each record, the time from its start to its middle
};

/// Divides the records into blocks of Units::block_s() for cross-validation. All blocks of a unit belong to
/// the same fold.
[[nodiscard]] Division divide_by_unit(const std::vector<Record>& records);

}  // namespace softgrip::sysid
