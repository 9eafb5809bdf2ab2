#pragma once
// Logs that a model generates, with added noise. Tests check that a fit to these logs finds the parameters of
// the model.

#include <cstdint>
#include <string>

#include "model/model.h"
#include "model/signals.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Reads the model file config/models/NAME.yaml.
[[nodiscard]] model::Model loaded(const std::string& name);

/// Simulates the response of the model to a signal, sampled at `rate_hz`. The model starts at rest. @param
/// noise_mm  standard deviation of the noise. @param correlation  correlation of the noise between successive
/// samples.
[[nodiscard]] Log simulated(const model::Model& model, model::SignalName signal, double rate_hz,
                            double noise_mm, std::uint64_t seed, double correlation = 0);

/// Multiplies every parameter that a fit may change by exp(N(0, share^2)).
[[nodiscard]] model::Model scattered(model::Model model, double share, std::uint64_t seed);

}  // namespace softgrip::sysid
