#pragma once
// The parts of repeated records that are predicted while a model is fitted to the others.

#include <cstddef>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

struct Division;

/// A unit is a run. Of many runs, a unit is a few of them. Of a single run the units are its two halves:
/// within one run nothing shows how runs differ.
class Units {
 public:
  Units() = default;
  /// @param records  one at least, each with one sample at least.
  explicit Units(const std::vector<Record>& records);

  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] std::size_t runs() const noexcept { return middle_s_.size(); }
  [[nodiscard]] bool are_runs() const noexcept { return runs() > 1; }
  /// The unit of a time of a record.
  /// @param since_start_s  since the record's first sample.
  [[nodiscard]] std::size_t unit_of(std::size_t record, double since_start_s) const noexcept;
  /// Records of the same samples without the readings of a unit (NaN). A record that belongs to the unit as a
  /// whole is left out.
  /// @param unit  count(): nothing is left out.
  /// @param kept  receives the index of each record that is returned; may be nullptr.
  [[nodiscard]] std::vector<Record> without(const std::vector<Record>& records, std::size_t unit,
                                            std::vector<std::size_t>* kept = nullptr) const;

 private:
  std::size_t count_ = 0;
  std::vector<double> middle_s_;  ///< of each record, since its start
};

/// Blocks of limits::block_s in which every unit is held out as a whole.
[[nodiscard]] Division divide_by_unit(const std::vector<Record>& records);

}  // namespace softgrip::sysid
