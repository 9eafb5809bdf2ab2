#pragma once
// Logs that the model itself generates, with added noise, for tests of parameter recovery.

#include <cstdint>
#include <string>

#include "model/model.h"
#include "model/signals.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Reads config/models/NAME.yaml.
[[nodiscard]] model::Model loaded(const std::string& name);

/// Simulates the response of the model to a signal from rest, sampled at `rate_hz`.
/// @param noise_mm  standard deviation. @param correlation  correlation of the noise between successive
/// samples.
[[nodiscard]] Log simulated(const model::Model& model, model::SignalName signal, double rate_hz,
                            double noise_mm, std::uint64_t seed, double correlation = 0);

/// Multiplies every parameter that may be fitted by exp(N(0, share^2)).
[[nodiscard]] model::Model scattered(model::Model model, double share, std::uint64_t seed);

}  // namespace softgrip::sysid
