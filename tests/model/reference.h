#pragma once
// The continuous equations of the chain's core, integrated by SUNDIALS CVODE: a referee that shares no
// formula with model/. Valve delay and lag, Bouc-Wen and Kelvin-Voigt; the rest of the chain is not in it.

#include <functional>
#include <vector>

namespace softgrip::model::testing {

/// The numbers of the equations, in the units of the model files.
struct Physics {
  double delay_s = 0, lag_s = 0;
  double alpha = 0, beta = 0, gamma = 0, eta = 0;
  int exponent = 1;
  double k0 = 1e300;
  std::vector<double> k, c;
};

/// Displacement at times i * sample_time_s for a command that is piecewise linear between the given samples
/// (the first one from rest at 0). Relative tolerance 1e-12.
[[nodiscard]] std::vector<double> integrate(const Physics& physics, const std::vector<double>& command_kpa,
                                            double sample_time_s);

}  // namespace softgrip::model::testing
