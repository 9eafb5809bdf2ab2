#pragma once
// What a fit may change: parameters of the model and the states in which records begin, scaled for the
// minimiser.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// One free number. The minimiser sees z = value / scale or, for what is positive by nature (stiffnesses,
/// dampings), z = ln(value).
struct FreeParameter {
  enum class Kind { model, offset, peak_before, unsettled };
  Kind kind = Kind::model;
  std::size_t flat_index = 0;  ///< of a model parameter
  std::size_t record = 0;      ///< of a start state
  std::size_t branch = 0;      ///< of unsettled creep
  std::string name;            ///< "kelvin_voigt.k1_kpa_per_mm", "tp1: offset_mm"
  std::string unit;            ///< in which the value is
  bool logarithmic = false;
  double scale = 1;
  double lower = 0;  ///< of the value
  double upper = 0;

  [[nodiscard]] double to_z(double value) const;
  [[nodiscard]] double to_value(double z) const;
  /// d value / d z
  [[nodiscard]] double slope(double z) const;
  [[nodiscard]] double lower_z() const { return to_z(lower); }
  [[nodiscard]] double upper_z() const { return to_z(upper); }
};

/// Whether a fit of a base moves this number: no exponent, nothing that stands where it was put, and of the
/// springs no k0 where the hysteresis has an instantaneous gain (only their sum shows).
[[nodiscard]] bool is_movable(const model::Model& model, std::size_t flat_index);

/// A point of the search: a whole model and the start of every record.
struct FitPoint {
  model::Model model;
  std::vector<StartState> starts;
};

/// Which parameters are free, in the order of the z vector.
class FitSpace {
 public:
  /// All of `free_flat` (indices of flat_values(model)) and what the records' starts leave open.
  /// @param model  gives the values of what stays fixed.
  FitSpace(const model::Model& model, const std::vector<Record>& records,
           const std::vector<std::size_t>& free_flat);

  [[nodiscard]] std::size_t size() const noexcept { return free_.size(); }
  [[nodiscard]] const std::vector<FreeParameter>& free() const noexcept { return free_; }
  /// Keeps the records' starts as they are given: they are not free any more.
  void hold_starts(const std::vector<StartState>& starts);
  /// Narrows the bounds of one parameter (to within what its declaration allows).
  void bound(std::size_t index, double lower, double upper);

  [[nodiscard]] FitPoint point(std::span<const double> z) const;
  [[nodiscard]] std::vector<double> z(const FitPoint& point) const;
  /// The value of parameter `index` at a point.
  [[nodiscard]] double value(const FitPoint& point, std::size_t index) const;

 private:
  model::Model base_;
  std::vector<StartState> base_starts_;
  std::vector<FreeParameter> free_;
};

/// Start states with settled creep and without offset, at rest where a record starts there; with as many
/// unsettled branches as the model has.
[[nodiscard]] std::vector<StartState> rest_starts(const model::Model& model,
                                                  const std::vector<Record>& records);

}  // namespace softgrip::sysid
