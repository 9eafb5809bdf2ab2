#pragma once
// Provides the test signals. The test signals are pressure commands that start and end at 0 kPa and do not
// exceed 60 kPa.

#include <optional>
#include <string_view>
#include <vector>

namespace softgrip::model {

enum class SignalName { tp1, tp2, sp1, sp2, steps, hold };

/// Returns the test signal with this name; nullopt if no test signal has this name.
[[nodiscard]] std::optional<SignalName> signal_named(std::string_view name);
[[nodiscard]] std::string_view name_of(SignalName signal);
/// Returns all test signals.
[[nodiscard]] const std::vector<SignalName>& all_signals();

/// Returns the duration of the signal [s].
[[nodiscard]] double duration_s(SignalName signal);
/// Returns the commanded pressure at `time_s` [kPa]; 0 outside [0, duration_s].
[[nodiscard]] double value_kpa(SignalName signal, double time_s);

}  // namespace softgrip::model
