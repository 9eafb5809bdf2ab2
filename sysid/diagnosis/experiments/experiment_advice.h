#pragma once
// Gives advice on measurements that separate two causes, in addition to a waveform or in place of a waveform.

#include <string>
#include <string_view>
#include <vector>

namespace softgrip::sysid {

struct AdviceFacts {
  bool pressure_recorded = false;  ///< true: the logs have a pressure_kpa column
  bool temperature_varies = false;
  bool separable = false;          ///< true: a waveform separates the two causes
  bool gauge_made = false;         ///< true: the sensor was already checked against a gauge
  bool may_be_pressurised = true;  ///< false: neither the logs nor the limits contain a pressure above 0
};

/// Returns advice on how to separate the causes with the ids `one` and `other`. Each element consists of one
/// or more sentences. Some advice is given even if a waveform separates the causes, for example to record the
/// pressure.
[[nodiscard]] std::vector<std::string> advice_for(std::string_view one, std::string_view other,
                                                  const AdviceFacts& facts);

/// Returns sentences that propose a check of the sensor against a gauge and describe the procedure.
[[nodiscard]] std::string gauge_advice(const std::vector<double>& positions_mm,
                                       const std::vector<std::string>& separates);

}  // namespace softgrip::sysid
