#pragma once
// A record walked through a chain, for any number type.

#include <span>
#include <vector>

#include "model/model.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// What the model says the sensor should have read at every sample of the record [mm]: simulated from the
/// start, the hidden state never corrected by the readings.
[[nodiscard]] std::vector<double> predict(const model::Model& model, const Record& record,
                                          const StartState& start);

/// Adds what the start leaves in the readings besides the chain's state: the offset and the creep that had
/// not settled.
/// @param series_mm  as long as the record.
void add_start(const model::Model& model, const Record& record, const StartState& start,
               std::vector<double>& series_mm);

/// Reading minus prediction where there is a reading, NaN elsewhere [mm].
[[nodiscard]] std::vector<double> residual(const Record& record, const std::vector<double>& prediction);

/// Root of the mean square of the finite values.
[[nodiscard]] double rms(std::span<const double> values);

/// Root of the mean square error of all readings [mm]; infinity if a prediction is not finite.
/// @param starts  by record.
[[nodiscard]] double rmse_of(const model::Model& model, const std::vector<StartState>& starts,
                             const std::vector<Record>& records);

/// The time constants c/k of the model's Kelvin-Voigt branches [s] (of the first such block).
[[nodiscard]] std::vector<double> branch_time_constants_s(const model::Model& model);

}  // namespace softgrip::sysid
