#pragma once
// A finger that is integrated by a program without any code of model/. It uses the equations of the
// literature and the classical fourth-order Runge-Kutta method with 50 steps per sample.

#include <cstdint>

#include "model/model.h"
#include "model/signals.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

struct IntegratedFinger {
  double alpha = 0.30, beta = 0.19, gamma = 0.022, eta = 0.041;  // mm/kPa, 1/kPa
  double k0 = 310, k1 = 17, c1 = 215, k2 = 3.7, c2 = 1.9;        // kPa/mm, kPa s/mm
};

/// Returns the response of the finger to a signal from rest, with white noise.
[[nodiscard]] Log integrated(const IntegratedFinger& finger, model::SignalName signal, double rate_hz,
                             double noise_mm, std::uint64_t seed);

/// Returns the pressure behind the valve of a model for the command of a log.
[[nodiscard]] std::vector<double> pressures_behind(const model::Model& model, const Log& log);

}  // namespace softgrip::sysid
