#pragma once
// Logs made by the model itself, with noise of our own: for tests of recovery.

#include <cstdint>
#include <string>

#include "model/model.h"
#include "model/signals.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// config/models/NAME.yaml
[[nodiscard]] model::Model loaded(const std::string& name);

/// The model's answer to a signal, sampled at `rate_hz`, from rest.
/// @param noise_mm  standard deviation. @param correlation  of the noise from one sample to the next.
[[nodiscard]] Log simulated(const model::Model& model, model::SignalName signal, double rate_hz,
                            double noise_mm, std::uint64_t seed, double correlation = 0);

/// Every parameter that may be fitted multiplied by exp(N(0, share^2)).
[[nodiscard]] model::Model scattered(model::Model model, double share, std::uint64_t seed);

}  // namespace softgrip::sysid
