#pragma once
// The difference between model and readings over whole trajectories, with exact derivatives.

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Prediction minus reading for every reading of every record, in order. Evaluating is thread-safe.
class Residuals {
 public:
  virtual ~Residuals() = default;

  /// How many residuals.
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] const FitSpace& space() const noexcept { return space_; }
  [[nodiscard]] const std::vector<Record>& records() const noexcept { return records_; }

  /// @param z  in the coordinates of space(). @param r  count() residuals [mm], or empty.
  /// @param jacobian  count() rows of space().size(), derivatives by z, or empty.
  /// Returns false where the model is not defined or its answer not finite.
  [[nodiscard]] virtual bool evaluate(std::span<const double> z, std::span<double> r,
                                      std::span<double> jacobian) const = 0;

 protected:
  Residuals(const std::vector<Record>& records, FitSpace space);

  const std::vector<Record>& records_;
  FitSpace space_;
  std::size_t count_ = 0;
};

/// For any chain: automatic differentiation through its steps. `records` must outlive the result.
[[nodiscard]] std::unique_ptr<Residuals> chain_residuals(const std::vector<Record>& records, FitSpace space);

/// For a chain of Bouc-Wen with exponent 1 and Kelvin-Voigt behind at most one delay and one valve lag: the
/// same numbers from sensitivities in closed form, several times faster. nullptr for any other chain.
[[nodiscard]] std::unique_ptr<Residuals> separable_residuals(const std::vector<Record>& records,
                                                             FitSpace space);

/// The faster of the two that serves.
[[nodiscard]] std::unique_ptr<Residuals> residuals_for(const std::vector<Record>& records,
                                                       const FitSpace& space);

}  // namespace softgrip::sysid
