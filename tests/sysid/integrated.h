#pragma once
// A simulated finger that uses no code of model/. The equations are taken from the literature. The classical
// fourth-order Runge-Kutta method integrates them with 50 steps per sample.

#include <cstdint>

#include "model/model.h"
#include "model/signals.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

struct IntegratedFinger {
  double alpha = 0.30, beta = 0.19, gamma = 0.022, eta = 0.041;  // alpha, beta in mm/kPa; gamma, eta in 1/kPa
  double k0 = 310, k1 = 17, c1 = 215, k2 = 3.7, c2 = 1.9;        // k0, k1, k2 in kPa/mm; c1, c2 in kPa s/mm
};

/// Simulates the response of the finger to a signal. The finger starts at rest. The readings contain white
/// noise.
[[nodiscard]] Log integrated(const IntegratedFinger& finger, model::SignalName signal, double rate_hz,
                             double noise_mm, std::uint64_t seed);

/// Simulates the valve of `model` for the commands of the log. Returns the pressure downstream of this valve.
[[nodiscard]] std::vector<double> pressures_behind(const model::Model& model, const Log& log);

}  // namespace softgrip::sysid
