#pragma once
// Residuals of a model over whole trajectories, with exact derivatives.

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Prediction minus reading for each reading of each record, in order. evaluate() is thread-safe.
class Residuals {
 public:
  virtual ~Residuals() = default;

  /// Returns the number of residuals.
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] const FitSpace& space() const noexcept { return space_; }
  [[nodiscard]] const std::vector<Record>& records() const noexcept { return records_; }

  /// Computes the residuals and the Jacobian. Returns false if the model is not defined at z, or if a value
  /// is not finite.
  /// @param z  in the coordinates of space(). @param r  count() residuals [mm], or empty.
  /// @param jacobian  derivatives with respect to z: count() rows of space().size(), or empty.
  [[nodiscard]] virtual bool evaluate(std::span<const double> z, std::span<double> r,
                                      std::span<double> jacobian) const = 0;

 protected:
  Residuals(const std::vector<Record>& records, FitSpace space);

  const std::vector<Record>& records_;
  FitSpace space_;
  std::size_t count_ = 0;
};

/// Returns residuals for any chain, by automatic differentiation of its steps. `records` must outlive the
/// result.
[[nodiscard]] std::unique_ptr<Residuals> chain_residuals(const std::vector<Record>& records, FitSpace space);

/// Returns residuals for a chain of at most one delay, at most one valve lag, Bouc-Wen with exponent 1 and
/// Kelvin-Voigt. Sensitivities in closed form give the same values several times faster. Returns nullptr for
/// any other chain.
[[nodiscard]] std::unique_ptr<Residuals> separable_residuals(const std::vector<Record>& records,
                                                             FitSpace space);

/// Returns separable_residuals() if possible, otherwise chain_residuals().
[[nodiscard]] std::unique_ptr<Residuals> residuals_for(const std::vector<Record>& records,
                                                       const FitSpace& space);

}  // namespace softgrip::sysid
