#pragma once
// Gives advice on causes that no waveform can separate.

#include <string>
#include <string_view>
#include <vector>

namespace softgrip::sysid {

struct AdviceFacts {
  bool pressure_recorded = false;  ///< the logs have pressure_kpa
  bool temperature_varies = false;
  bool separable = false;   ///< a waveform separates the two causes
  bool gauge_made = false;  ///< the sensor was checked against a gauge already
};

/// Returns advice, one sentence per element, on how to separate two causes, given by their ids. The list is
/// empty if a waveform is sufficient.
[[nodiscard]] std::vector<std::string> advice_for(std::string_view one, std::string_view other,
                                                  const AdviceFacts& facts);

/// Returns the sentence that proposes a check of the sensor against a gauge.
[[nodiscard]] std::string gauge_advice(const std::vector<double>& positions_mm,
                                       const std::vector<std::string>& separates);

}  // namespace softgrip::sysid
