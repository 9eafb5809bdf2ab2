#pragma once
// Gives advice on causes that no waveform can separate.

#include <string>
#include <string_view>
#include <vector>

namespace softgrip::sysid {

struct AdviceFacts {
  bool pressure_recorded = false;  ///< true: the logs have the column pressure_kpa
  bool temperature_varies = false;
  bool separable = false;   ///< true: a waveform separates the two causes
  bool gauge_made = false;  ///< true: the sensor was already checked against a gauge
};

/// Returns advice on how to separate the causes with the ids `one` and `other`. Each element is a sentence.
/// The list is empty if a waveform separates the causes.
[[nodiscard]] std::vector<std::string> advice_for(std::string_view one, std::string_view other,
                                                  const AdviceFacts& facts);

/// Returns the sentence that proposes a check of the sensor against a gauge.
[[nodiscard]] std::string gauge_advice(const std::vector<double>& positions_mm,
                                       const std::vector<std::string>& separates);

}  // namespace softgrip::sysid
