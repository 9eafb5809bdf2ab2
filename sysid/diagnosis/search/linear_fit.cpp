#include "sysid/diagnosis/search/linear_selection.h"

#include <memory>
#include <span>
#include <utility>

#include "sysid/fitting/minimise.h"
#include "sysid/fitting/residuals.h"

namespace softgrip::sysid {
namespace {

constexpr int look_iterations = 15;

/// Residuals as a function of the parameters of one cause. The part that the parameters of the base structure
/// can absorb is removed from these residuals.
class ResidualsBesideBase final : public Residuals {
 public:
  ResidualsBesideBase(const Scan& base, const std::vector<Record>& records, const FitSpace& of_the_cause)
      : Residuals(records, of_the_cause), base_(base), inner_(residuals_for(records, of_the_cause)) {}

  bool evaluate(std::span<const double> z, std::span<double> r, std::span<double> jacobian) const override {
    if (!inner_->evaluate(z, r, jacobian)) return false;
    const auto rows = static_cast<Eigen::Index>(count());
    if (!r.empty()) {
      Eigen::Map<Eigen::VectorXd> values(r.data(), rows);
      values = base_.left_of(values);
    }
    if (!jacobian.empty()) {
      Eigen::Map<Jacobian> slopes(jacobian.data(), rows, static_cast<Eigen::Index>(space().size()));
      slopes = base_.left_of(slopes);
    }
    return true;
  }
  [[nodiscard]] const Residuals& inner() const { return *inner_; }

 private:
  const Scan& base_;
  std::unique_ptr<Residuals> inner_;
};

}  // namespace

LinearFit linear_fit_from(const std::vector<Record>& records, const Scan& base, const Cause& cause,
                          const FitPoint& start) {
  const FitSpace numbers = cause_space(records, start, cause);
  const ResidualsBesideBase residuals(base, records, numbers);
  MinimiseOptions options;
  options.most_iterations = look_iterations;
  options.tolerance = 1e-5;
  const Minimum minimum = minimise(residuals, numbers.z(start), options);
  Eigen::VectorXd left(static_cast<Eigen::Index>(residuals.count()));
  if (!residuals.inner().evaluate(minimum.z, {left.data(), residuals.count()}, {})) return {};
  return {numbers.point(minimum.z), std::move(left), minimum.rmse_mm * minimum.rmse_mm};
}

}  // namespace softgrip::sysid
