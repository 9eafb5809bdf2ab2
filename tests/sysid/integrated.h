#pragma once
// A finger integrated by a program that shares nothing with model/: the equations as the literature writes
// them, Runge and Kutta's fourth-order method in time, steps fifty times finer than the samples.

#include <cstdint>

#include "model/model.h"
#include "model/signals.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

struct IntegratedFinger {
  double alpha = 0.30, beta = 0.19, gamma = 0.022, eta = 0.041;  // mm/kPa, 1/kPa
  double k0 = 310, k1 = 17, c1 = 215, k2 = 3.7, c2 = 1.9;        // kPa/mm, kPa s/mm
};

/// The finger's answer to a signal from rest, with white noise.
[[nodiscard]] Log integrated(const IntegratedFinger& finger, model::SignalName signal, double rate_hz,
                             double noise_mm, std::uint64_t seed);

/// The pressure behind the valve of a model for the command of a log.
[[nodiscard]] std::vector<double> pressures_behind(const model::Model& model, const Log& log);

}  // namespace softgrip::sysid
