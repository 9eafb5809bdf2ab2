#pragma once
// Computes a reference solution: SUNDIALS CVODE integrates the continuous equations. The code uses no formula
// from model/. The equations contain the delay and the lag of the valve, the Bouc-Wen element and the
// Kelvin-Voigt element. They contain no other block of the chain.

#include <vector>

namespace softgrip::model::testing {

/// Parameters of the equations, in the units of the model files.
struct Physics {
  double delay_s = 0, lag_s = 0;
  double alpha = 0, beta = 0, gamma = 0, eta = 0;
  int exponent = 1;
  double k0 = 1e300;
  std::vector<double> k, c;
};

/// Returns the displacement at the times i * sample_time_s. The command is linear between the samples. The
/// finger starts at rest with the command 0. The relative tolerance of the solution is 1e-12.
[[nodiscard]] std::vector<double> integrate(const Physics& physics, const std::vector<double>& command_kpa,
                                            double sample_time_s);

}  // namespace softgrip::model::testing
