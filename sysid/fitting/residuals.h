#pragma once
// Computes residuals of a model over complete trajectories, with exact derivatives.

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Jacobian of residuals: one row for each residual and one column for each coordinate, in the order in which
/// Residuals::evaluate() writes them.
using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Prediction minus reading for all readings, record by record. evaluate() is thread-safe.
class Residuals {
 public:
  virtual ~Residuals() = default;

  /// Returns the number of residuals.
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] const FitSpace& space() const noexcept { return space_; }
  [[nodiscard]] const std::vector<Record>& records() const noexcept { return records_; }

  /// Computes the residuals and the Jacobian. Returns false if the model is not defined at z, or if a value
  /// is not finite.
  /// @param z  point in the coordinates of space().
  /// @param r  receives count() residuals [mm]; may be empty.
  /// @param jacobian  receives the derivatives with respect to z, in count() rows of space().size() elements;
  /// may be empty.
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

/// Returns residuals for a chain that consists of Bouc-Wen with exponent 1, Kelvin-Voigt, at most one delay
/// and at most one valve lag. The sensitivities of these blocks are computed in closed form. The values equal
/// those of chain_residuals(), but the computation is several times faster. Returns nullptr for any other
/// chain.
[[nodiscard]] std::unique_ptr<Residuals> separable_residuals(const std::vector<Record>& records,
                                                             FitSpace space);

/// Returns separable_residuals() if possible, otherwise chain_residuals().
[[nodiscard]] std::unique_ptr<Residuals> residuals_for(const std::vector<Record>& records,
                                                       const FitSpace& space);

}  // namespace softgrip::sysid
