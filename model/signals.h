#pragma once
// Provides the test signals. The test signals are pressure commands that start and end at 0 kPa and do not
// exceed 60 kPa.

#include <string_view>

#include "base/enum_table.h"

namespace softgrip::model {

enum class SignalName { tp1, tp2, sp1, sp2, steps, hold };

/// Names of the test signals.
inline constexpr auto signal_names = enum_names<SignalName>({{SignalName::tp1, "tp1"},
                                                             {SignalName::tp2, "tp2"},
                                                             {SignalName::sp1, "sp1"},
                                                             {SignalName::sp2, "sp2"},
                                                             {SignalName::steps, "steps"},
                                                             {SignalName::hold, "hold"}});
[[nodiscard]] constexpr std::string_view name_of(SignalName signal) noexcept {
  return signal_names[signal];
}

/// Returns the duration of the signal [s].
[[nodiscard]] double duration_s(SignalName signal);
/// Returns the commanded pressure at `time_s` [kPa]; 0 outside [0, duration_s].
[[nodiscard]] double value_kpa(SignalName signal, double time_s);

}  // namespace softgrip::model
