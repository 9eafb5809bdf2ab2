#pragma once
// Simulates a separable chain in closed form, with all sensitivities. The chain consists of at most one
// transport delay and at most one valve lag, followed by Bouc-Wen with exponent 1 and Kelvin-Voigt branches.
//
// The hysteretic state is h = beta g. The equation of g is g' = p' - gamma p' |g| - eta |p'| g, which does
// not contain beta. The displacement
//
//   y = A p - beta g + sum_b a_b w_b + offset + sum_b u_b exp(-r_b t),   w_b' = p - r_b w_b,
//
// is linear in A = alpha + 1/k0, beta, a_b = 1/c_b, the offset, and the unsettled creep u_b at the start. The
// nonlinear parameters are gamma + eta ("growing"), gamma - eta ("shrinking"), the rates r_b = k_b/c_b, the
// delay, the lag, and the peak before the start of a record. A search iterates only over the nonlinear
// parameters (variable projection).

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "model/model.h"
#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A segment of the pressure curve at the actuator. Members with `_by_lag` are derivatives with respect to
/// the time constant of the lag.
struct Stretch {
  double end_kpa = 0;
  double mean_kpa = 0;
  double end_by_lag = 0;
  double mean_by_lag = 0;
  /// Pressure at a reversal within the segment; NaN: the segment contains no reversal.
  double turn_kpa = std::numeric_limits<double>::quiet_NaN();
  double turn_by_lag = 0;
  double rate_kpa_per_s = 0;   ///< slope of the pressure at the end of the segment
  std::uint32_t duration = 0;  ///< index of the segment's duration in PressureWalk::duration_s
  bool ends_sample = false;    ///< true: the segment ends at a sample
};

/// The segments of the pressure in a record. The first segment begins at the first sample.
struct PressureWalk {
  double first_kpa = 0;
  std::vector<Stretch> stretches;
  std::vector<double> duration_s;  ///< list of all different durations of segments
};

/// Computes the pressure at the actuator.
/// @param delay_s,lag_s  delay and time constant of the lag; 0: absent.
[[nodiscard]] PressureWalk walk_pressure(const Record& record, double delay_s, double lag_s);

/// Indices of the blocks of a separable chain in Model::blocks, and the number of Kelvin-Voigt branches.
struct SeparableShape {
  std::optional<std::size_t> delay;
  std::optional<std::size_t> lag;
  std::size_t bouc_wen = 0;
  std::size_t kelvin_voigt = 0;
  std::size_t branches = 0;
};

/// Returns the indices of the blocks of a separable model; nullopt if the model is not separable.
[[nodiscard]] std::optional<SeparableShape> separable_shape(const model::Model& model);

/// The parameters of a separable chain. The names are the symbols in the equations at the top of this file.
struct SeparablePoint {
  double growing_per_kpa = 0;
  double shrinking_per_kpa = 0;
  double delay_s = 0;
  double lag_s = 0;
  std::vector<double> rate_hz;     ///< rate k/c of each branch [1/s]
  double instantaneous = 0;        ///< instantaneous gain alpha + 1/k0 [mm/kPa]
  double beta = 0;                 ///< parameter beta of the Bouc-Wen element [mm/kPa]
  std::vector<double> amplitude;   ///< amplitude 1/c of each branch [mm/(kPa s)]
  std::vector<StartState> starts;  ///< initial state of each record
};

[[nodiscard]] SeparablePoint to_separable(const SeparableShape& shape, const FitPoint& point);

/// Indices of the columns of one record. The columns of the linear parameters come first. Such a column
/// contains the factor of its parameter in the equation of y.
struct SeparableColumns {
  std::size_t branches = 0;
  bool has_start = false;  ///< true: there are columns for unsettled creep and peak

  [[nodiscard]] static constexpr Eigen::Index pressure() { return 0; }
  /// Index of the column that contains -g.
  [[nodiscard]] static constexpr Eigen::Index hysteresis() { return 1; }
  [[nodiscard]] Eigen::Index branch(std::size_t b) const { return 2 + static_cast<Eigen::Index>(b); }
  [[nodiscard]] Eigen::Index offset() const { return branch(branches); }
  [[nodiscard]] Eigen::Index unsettled(std::size_t b) const {
    return offset() + 1 + static_cast<Eigen::Index>(b);
  }
  [[nodiscard]] Eigen::Index linear() const { return has_start ? unsettled(branches) : offset() + 1; }
  // From this index on, the columns contain the sensitivities of y to the nonlinear parameters, with the
  // linear parameters held constant.
  [[nodiscard]] Eigen::Index growing() const { return linear(); }
  [[nodiscard]] Eigen::Index shrinking() const { return linear() + 1; }
  [[nodiscard]] Eigen::Index rate(std::size_t b) const { return linear() + 2 + static_cast<Eigen::Index>(b); }
  [[nodiscard]] Eigen::Index delay() const { return rate(branches); }
  [[nodiscard]] Eigen::Index lag() const { return delay() + 1; }
  [[nodiscard]] Eigen::Index peak() const { return delay() + 2; }
  [[nodiscard]] Eigen::Index all() const { return delay() + (has_start ? 3 : 2); }
};

/// A record that is prepared for many evaluations.
class SeparableRecord {
 public:
  SeparableRecord(const Record& record, const SeparableShape& shape);

  [[nodiscard]] const Record& record() const noexcept { return record_; }
  [[nodiscard]] const SeparableColumns& columns() const noexcept { return columns_; }

  /// Receiver of up to `block_rows` consecutive rows, one per reading. A row consists of the columns that
  /// SeparableColumns::linear() or all() counts, and of one more column. This last column is the reading, or
  /// prediction minus reading if the sensitivities are included.
  class Sink {
   public:
    virtual ~Sink() = default;
    virtual void block(const Eigen::Ref<const Eigen::MatrixXd>& rows) = 0;
  };
  static constexpr Eigen::Index block_rows = 128;

  /// Passes the linear columns and the readings to `sink`. The nonlinear parameters are taken from `point`.
  void linear(const SeparablePoint& point, std::size_t index, Sink& sink) const;
  /// Passes all columns and the residual to `sink`.
  /// @param index  index of the record in point.starts.
  void full(const SeparablePoint& point, std::size_t index, Sink& sink) const;

 private:
  const Record& record_;
  SeparableShape shape_;
  SeparableColumns columns_;
  PressureWalk still_;  ///< pressure for a chain without delay and lag; it does not depend on the parameters
};

}  // namespace softgrip::sysid
