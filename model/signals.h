#pragma once
// The test signals, defined once: pressure commands that start and end at 0 and stay at or below 60 kPa.

#include <optional>
#include <string_view>
#include <vector>

namespace softgrip::model {

enum class SignalName { tp1, tp2, sp1, sp2, steps, hold };

/// The name as users write it, or nothing.
[[nodiscard]] std::optional<SignalName> signal_named(std::string_view name);
[[nodiscard]] std::string_view name_of(SignalName signal);
/// All of them, for help texts and tests.
[[nodiscard]] const std::vector<SignalName>& all_signals();

/// How long the signal lasts [s].
[[nodiscard]] double duration_s(SignalName signal);
/// The commanded pressure [kPa] at `time_s` (0 outside [0, duration_s]).
[[nodiscard]] double value_kpa(SignalName signal, double time_s);

}  // namespace softgrip::model
