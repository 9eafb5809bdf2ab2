#pragma once
// What no waveform can tell apart, and what would.

#include <string>
#include <string_view>
#include <vector>

namespace softgrip::sysid {

struct AdviceFacts {
  bool pressure_recorded = false;  ///< the logs have pressure_kpa
  bool temperature_varies = false;
  bool separable = false;   ///< some waveform tells the two apart
  bool gauge_made = false;  ///< the sensor was checked against a gauge already
};

/// Sentences about two causes, by id; empty where a waveform is all that is needed.
[[nodiscard]] std::vector<std::string> advice_for(std::string_view one, std::string_view other,
                                                  const AdviceFacts& facts);

/// The sentence that asks for a check of the sensor against a gauge.
[[nodiscard]] std::string gauge_advice(const std::vector<double>& positions_mm,
                                       const std::vector<std::string>& separates);

}  // namespace softgrip::sysid
