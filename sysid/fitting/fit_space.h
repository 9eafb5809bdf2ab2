#pragma once
// Defines the free parameters of a fit. These are model parameters and initial states of records, scaled for
// the minimiser.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// One free parameter. The minimiser uses z = value / scale, or z = ln(value) for parameters that are always
/// positive (stiffnesses, dampings).
struct FreeParameter {
  enum class Kind { model, offset, peak_before, unsettled };
  Kind kind = Kind::model;
  std::size_t flat_index = 0;  ///< index of a model parameter in the list of all parameter values
  std::size_t record = 0;      ///< index of the record to which an initial state belongs
  std::size_t branch = 0;      ///< index of the creep branch to which unsettled creep belongs
  std::string name;            ///< name of the parameter: "kelvin_voigt.k1_kpa_per_mm", "tp1: offset_mm"
  std::string unit;            ///< unit of the parameter's value
  bool logarithmic = false;
  double scale = 1;
  double lower = 0;  ///< lower bound of the parameter's value
  double upper = 0;

  [[nodiscard]] double to_z(double value) const;
  [[nodiscard]] double to_value(double z) const;
  /// Returns the derivative of the parameter's value with respect to its coordinate z in the minimiser.
  [[nodiscard]] double slope(double z) const;
  [[nodiscard]] double lower_z() const { return to_z(lower); }
  [[nodiscard]] double upper_z() const { return to_z(upper); }
};

/// Returns true if a fit of a model structure may change this parameter. Exponents and parameters on a fixed
/// grid, such as thresholds, are not changed. The shape parameters of the envelope are not changed if the
/// play operators of the model have no envelope. The spring k0 is fixed if the hysteresis has an
/// instantaneous gain, because the data determine only the sum of that gain and 1/k0.
[[nodiscard]] bool is_movable(const model::Model& model, std::size_t flat_index);

/// A point of a search: a complete model, and the initial state of each record.
struct FitPoint {
  model::Model model;
  std::vector<StartState> starts;
};

/// The free parameters of a fit. Their order is that of the coordinates in the vector z of the minimiser.
class FitSpace {
 public:
  /// Makes two kinds of parameters free: those in `free_flat` (indices of flat_values(model)), and the
  /// unknown initial states.
  /// @param model  model with the values of the fixed parameters.
  FitSpace(const model::Model& model, const std::vector<Record>& records,
           const std::vector<std::size_t>& free_flat);

  [[nodiscard]] std::size_t size() const noexcept { return free_.size(); }
  [[nodiscard]] const std::vector<FreeParameter>& free() const noexcept { return free_; }
  /// Fixes the initial states of the records to the values in `starts`.
  void hold_starts(const std::vector<StartState>& starts);
  /// Fixes the last valley of the pressure before each record, and the rate of the pressure at the first
  /// sample, to the values in `starts`.
  void hold_arrivals(const std::vector<StartState>& starts);
  /// Narrows the bounds of parameter `index` to the given range. A bound is never moved outwards.
  void bound(std::size_t index, double lower, double upper);

  [[nodiscard]] FitPoint point(std::span<const double> z) const;
  [[nodiscard]] std::vector<double> z(const FitPoint& point) const;
  /// Returns the value of parameter `index` at a point of the search.
  [[nodiscard]] double value(const FitPoint& point, std::size_t index) const;

 private:
  model::Model base_;
  std::vector<StartState> base_starts_;
  std::vector<FreeParameter> free_;
};

/// Returns initial states without unsettled creep and with zero offset. A record with a known initial state
/// begins at rest. If the initial state is unknown, the previous peak is halfway between the first and the
/// largest pressure. `unsettled_mm` has one element for each branch of the model.
[[nodiscard]] std::vector<StartState> rest_starts(const model::Model& model,
                                                  const std::vector<Record>& records);

}  // namespace softgrip::sysid
