#pragma once
// Sentences of the warnings that a diagnosis of a change gives about its logs.

#include <string>
#include <string_view>
#include <vector>

namespace softgrip::sysid {

/// @param logs  names of the healthy and later logs that were recorded in a closed loop.
[[nodiscard]] std::string closed_loops(const std::vector<std::string>& logs);

/// @param record  later log that begins in a state (pressurised or vented) in which no healthy log begins.
[[nodiscard]] std::string other_start(const std::string& record);

/// @param factor  factor by which the unfamiliar input increases the permitted mean square error.
[[nodiscard]] std::string unfamiliar_input(double factor);

/// @param share  share of the measured pressures that are not evaluated, 0 .. 1.
[[nodiscard]] std::string unfamiliar_commands(double share);

/// @param record  the only later log whose error is larger than expected for a further healthy run.
[[nodiscard]] std::string unusual_log(const std::string& record);

/// @param percent  difference of the gain in the later logs from the healthy gain [%]; it is not significant.
/// @param is_limited  true: the difference is the largest one that the fit permits.
[[nodiscard]] std::string unusual_gain(double percent, bool is_limited);

/// @param zero_mm  zero offset in the later logs minus the mean zero offset in the healthy logs.
/// @param spread_mm  standard deviation of the zero offset between healthy runs.
/// @param unit  unit of both.
[[nodiscard]] std::string unusual_zero(double zero_mm, double spread_mm, std::string_view unit);

}  // namespace softgrip::sysid
