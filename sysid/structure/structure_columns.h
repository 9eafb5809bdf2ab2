#pragma once
// What every operator of a structure does with the pressure of the records: the columns of which the reading
// is a weighted sum, before the characteristic.

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "sysid/logs/record.h"
#include "sysid/structure/driven_pressure.h"
#include "sysid/structure/structure.h"

namespace softgrip::sysid {

/// Where the columns of a structure stand. Those before own() are behind the characteristic's input and have
/// weights that are not negative; a record's own (offset, unsettled creep, wandering zero) are added behind
/// it and may have either sign.
class ColumnLayout {
 public:
  ColumnLayout(const BaseStructure& structure, const StructureGrid& grid, const std::vector<Record>& records);

  [[nodiscard]] static constexpr Eigen::Index elastic() { return 0; }
  /// Play by play, or the one of Bouc-Wen's element: steepest_state() times the pressure, minus its state
  /// over beta.
  [[nodiscard]] static constexpr Eigen::Index hysteresis(std::size_t i) {
    return 1 + static_cast<Eigen::Index>(i);
  }
  [[nodiscard]] Eigen::Index creep(std::size_t branch) const {
    return hysteresis(hysteretic_) + static_cast<Eigen::Index>(branch);
  }
  [[nodiscard]] Eigen::Index hinged(std::size_t hinge, std::size_t branch) const {
    return creep(branches_) + static_cast<Eigen::Index>(hinge * hinge_branches_ + branch);
  }
  [[nodiscard]] Eigen::Index own() const { return hinged(hinges_, 0); }
  /// -1: the record has none.
  [[nodiscard]] Eigen::Index offset(std::size_t record) const { return offset_[record]; }
  [[nodiscard]] Eigen::Index unsettled(std::size_t record) const { return unsettled_[record]; }
  /// The first of knots() columns, straight between knots that stand `knot_interval_s` apart from the
  /// record's first sample on; the zero at that sample is no column.
  [[nodiscard]] Eigen::Index wandering(std::size_t record) const { return wandering_[record]; }
  [[nodiscard]] std::size_t knots(std::size_t record) const { return knots_[record]; }
  static constexpr double knot_interval_s = 20;
  [[nodiscard]] Eigen::Index count() const { return count_; }
  [[nodiscard]] std::size_t records() const { return offset_.size(); }

  [[nodiscard]] std::size_t hysteretic() const { return hysteretic_; }
  [[nodiscard]] std::size_t branches() const { return branches_; }
  [[nodiscard]] std::size_t hinges() const { return hinges_; }
  [[nodiscard]] std::size_t hinge_branches() const { return hinge_branches_; }

 private:
  std::size_t hysteretic_, branches_, hinges_, hinge_branches_;
  std::vector<Eigen::Index> offset_, unsettled_, wandering_;
  std::vector<std::size_t> knots_;
  Eigen::Index count_ = 0;
};

/// The largest slope of Bouc-Wen's normalised state over pressure, at the turn of a saturated loop: 2
/// eta/(gamma + eta), 1 at least. An elastic gain of beta times it keeps the element monotone.
[[nodiscard]] double steepest_state(const NonlinearNumbers& numbers);

/// Which samples are rows: those with a reading.
struct RowPlace {
  std::size_t record = 0;
  std::size_t sample = 0;
};
[[nodiscard]] std::vector<RowPlace> rows_of(const std::vector<Record>& records);

/// One row per reading, one column per layout: mm per mm/kPa (that is, kPa) before own(), 1 and decaying
/// exponentials from there.
class StructureColumns {
 public:
  /// `records`, `structure` and `grid` outlive it.
  StructureColumns(const std::vector<Record>& records, const BaseStructure& structure,
                   const StructureGrid& grid);

  /// `structure` says which of the numbers count. Only what differs from the last call is computed: the
  /// delay and the lags are the dear ones. Each record on whatever thread is idle. Valid until the next call.
  [[nodiscard]] const Eigen::MatrixXd& at(const NonlinearNumbers& numbers);

 private:
  void write_driven(std::size_t record);
  void write_hysteresis(std::size_t record);
  void write_own();

  const std::vector<Record>& records_;
  const BaseStructure& structure_;
  const StructureGrid& grid_;
  ColumnLayout layout_;
  std::vector<std::size_t> first_row_;  ///< of every record
  Eigen::MatrixXd columns_;
  NonlinearNumbers numbers_;            ///< of columns_
  std::vector<DrivenPressure> driven_;  ///< of every record; empty: at() was not called yet
};

/// The same for once.
[[nodiscard]] Eigen::MatrixXd structure_columns(const std::vector<Record>& records,
                                                const BaseStructure& structure, const StructureGrid& grid,
                                                const NonlinearNumbers& numbers);

}  // namespace softgrip::sysid
