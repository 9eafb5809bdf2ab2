#pragma once
// Computes the regressor matrix of a structure. Each column is the response of one operator to the pressure
// of the records. The displacement before the characteristic is the weighted sum of the columns. The pressure
// in the finger is the drive of a record after the delay, the lags and the rate limit of the structure. A
// regulator may replace the lags and the rate limit.

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "model/segment.h"
#include "sysid/logs/record.h"
#include "sysid/structure/ladder.h"
#include "sysid/structure/structure.h"

namespace softgrip::sysid {

/// Pressure in the finger during one record, as a sequence of segments. The segments contain no approximation
/// if the drive is linear or constant between samples.
struct DrivenPressure {
  double first_kpa = 0;                          ///< pressure at the first sample
  std::vector<model::Segment<double>> segments;  ///< segments with durations in s and pressures in kPa
  /// For each sample: number of segments that end at the time of this sample or before.
  std::vector<std::size_t> until;

  [[nodiscard]] double at_kpa(std::size_t sample) const {
    return until[sample] == 0 ? first_kpa : segments[until[sample] - 1].end;
  }
};

/// Computes the pressure and stores it in `driven`. The function reuses the memory of `driven`, because a
/// search calls it thousands of times.
/// @param index  index of the record in `numbers.jumped_from_kpa`.
/// @param numbers  nonlinear parameters. The function reads only the parameters of delay, lags, rate limit,
/// regulator and initial jump.
void drive(const Record& record, std::size_t index, const BaseStructure& structure,
           const NonlinearNumbers& numbers, DrivenPressure& driven);

/// Column indices of a structure. The columns before mode(0) have weights that are not negative, except the
/// elastic gain of a linear structure. The columns of the linear modes have weights of either sign. The
/// weighted sum of all columns before own() is the input of the characteristic. The columns of each record
/// (offset, unsettled creep, drift of the zero offset) are added after the characteristic, and their weights
/// may have either sign.
class ColumnLayout {
 public:
  ColumnLayout(const BaseStructure& structure, const StructureGrid& grid, const std::vector<Record>& records);

  [[nodiscard]] static constexpr Eigen::Index elastic() { return 0; }
  /// Returns the column of play operator i, or of the Bouc-Wen element for i = 0. The column of the Bouc-Wen
  /// element is steepest_state() times the pressure minus the normalised state of the element.
  [[nodiscard]] static constexpr Eigen::Index hysteresis(std::size_t i) {
    return 1 + static_cast<Eigen::Index>(i);
  }
  [[nodiscard]] Eigen::Index creep(std::size_t branch) const {
    return hysteresis(hysteretic_) + static_cast<Eigen::Index>(branch);
  }
  /// Returns the smallest weight of a creep branch [mm/kPa]. It is above 0 if the unsettled creep of a record
  /// needs the time constant of the branch. The model then contains the branch even without creep, and the
  /// weight must be a compliance that the block of the branch can represent.
  [[nodiscard]] double least_creep_mm_per_kpa(std::size_t branch) const { return least_creep_[branch]; }
  [[nodiscard]] Eigen::Index hinged(std::size_t hinge, std::size_t branch) const {
    return creep(branches_) + static_cast<Eigen::Index>(hinge * hinge_branches_ + branch);
  }
  /// Returns the first of the two columns of a linear mode. They are the output of the mode, and its rate of
  /// change divided by the angular frequency.
  [[nodiscard]] Eigen::Index mode(std::size_t mode) const {
    return hinged(hinges_, 0) + 2 * static_cast<Eigen::Index>(mode);
  }
  [[nodiscard]] Eigen::Index own() const { return mode(modes_); }
  /// Returns the column of the offset of a record, or -1 if this offset is not fitted.
  [[nodiscard]] Eigen::Index offset(std::size_t record) const { return offset_[record]; }
  [[nodiscard]] Eigen::Index unsettled(std::size_t record) const { return unsettled_[record]; }
  /// Returns the first of the knots() columns of the piecewise linear drift of a record. The first knot is at
  /// the first sample of the record, and the distance between knots is knot_interval_s(). The drift is 0 at
  /// the first knot, so this knot has no column.
  [[nodiscard]] Eigen::Index zero_drift(std::size_t record) const { return zero_drift_[record]; }
  [[nodiscard]] std::size_t knots(std::size_t record) const { return knots_[record]; }
  /// Returns the distance between two knots [s]: 20 units of time_unit_s(), and at least 1/16 of the longest
  /// record. With a shorter distance, the drift would follow the load cycles, and a fit to a record of many
  /// hours would have thousands of columns.
  [[nodiscard]] double knot_interval_s() const { return knot_interval_s_; }
  [[nodiscard]] Eigen::Index count() const { return count_; }
  [[nodiscard]] std::size_t records() const { return offset_.size(); }

  [[nodiscard]] std::size_t hysteretic() const { return hysteretic_; }
  [[nodiscard]] std::size_t branches() const { return branches_; }
  [[nodiscard]] std::size_t hinges() const { return hinges_; }
  [[nodiscard]] std::size_t hinge_branches() const { return hinge_branches_; }
  [[nodiscard]] std::size_t modes() const { return modes_; }
  /// Returns true if the weight of the column elastic() may have either sign.
  [[nodiscard]] bool linear() const { return linear_; }

 private:
  std::size_t hysteretic_, branches_, hinges_, hinge_branches_, modes_;
  bool linear_;
  std::vector<Eigen::Index> offset_, unsettled_, zero_drift_;
  std::vector<std::size_t> knots_;
  std::vector<double> least_creep_;
  double knot_interval_s_;
  Eigen::Index count_ = 0;
};

/// Returns the largest slope of the normalised Bouc-Wen state with respect to pressure, which is 2 eta/(gamma
/// + eta) but at least 1. This slope occurs at the reversal of a saturated loop. The element is monotonic if
/// its elastic gain is at least beta times this slope.
[[nodiscard]] double steepest_state(const NonlinearNumbers& numbers);

/// Returns the smallest compliance [mm/kPa] of a creep branch with the time constant `tau_s` that the block
/// model::KelvinVoigt can represent.
[[nodiscard]] double least_compliance_mm_per_kpa(double tau_s);

/// Record and sample to which a row of the matrix belongs. Each sample with a reading has one row.
struct RowPlace {
  std::size_t record = 0;
  std::size_t sample = 0;
};
[[nodiscard]] std::vector<RowPlace> rows_of(const std::vector<Record>& records);
/// Returns the reading of each row [mm].
[[nodiscard]] Eigen::VectorXd readings_of_rows(const std::vector<Record>& records);

/// The regressor matrix. It has one row per reading and the columns of ColumnLayout. The columns before own()
/// are in kPa, and their weights are in mm/kPa. The other columns are dimensionless, and their weights are in
/// mm.
class StructureColumns {
 public:
  /// `records`, `structure` and `grid` must outlive the object.
  StructureColumns(const std::vector<Record>& records, const BaseStructure& structure,
                   const StructureGrid& grid);

  /// Returns the matrix for these nonlinear parameters. Parameters of components that the structure does not
  /// contain are ignored. Columns are recomputed only if their parameters have changed since the previous
  /// call. Most of the time is spent on the columns that depend on the delay and the lags. Idle threads
  /// process the records in parallel. The returned reference is valid until the next call.
  [[nodiscard]] const Eigen::MatrixXd& at(const NonlinearNumbers& numbers);

 private:
  void write_driven(std::size_t record);
  void write_mode(std::size_t record, std::size_t mode);
  void write_hysteresis(std::size_t record);
  void write_own();

  const std::vector<Record>& records_;
  const BaseStructure& structure_;
  const StructureGrid& grid_;
  ColumnLayout layout_;
  std::vector<std::size_t> first_row_;  ///< for each record, index of its first row
  Eigen::MatrixXd columns_;
  NonlinearNumbers numbers_;            ///< parameters with which columns_ was computed
  std::vector<DrivenPressure> driven_;  ///< pressure of each record; empty before the first call of at()
  /// For each record, the weights of its creep branches and of those above a hinge.
  std::vector<LadderWeights> ladder_weights_, hinge_weights_;
};

/// Returns the matrix of StructureColumns for a single set of parameters.
[[nodiscard]] Eigen::MatrixXd structure_columns(const std::vector<Record>& records,
                                                const BaseStructure& structure, const StructureGrid& grid,
                                                const NonlinearNumbers& numbers);

}  // namespace softgrip::sysid
