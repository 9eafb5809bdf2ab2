#pragma once
// Defines the result of a grip.

#include <cstdint>
#include <string_view>

namespace softgrip::control {

/// The result of one channel; it stays until a reset (acknowledge) or the next start.
enum class GripResult : std::uint8_t {
  none,       ///< no grip yet
  holding,    ///< HOLDING: an object was detected and verified
  no_part,    ///< NO PART: the finger moved as if free
  part_lost,  ///< PART LOST: the object was held before
  released,   ///< RELEASED
  error,      ///< ERROR: timeout, fault or stop before a result
};
/// Returns the name for users: "HOLDING", "NO PART", "PART LOST", "RELEASED", "ERROR"; "-" for none.
[[nodiscard]] std::string_view title_of(GripResult result) noexcept;
/// Returns the name for programs: "holding", "no_part", ...
[[nodiscard]] std::string_view name_of(GripResult result) noexcept;

/// The evidence of a verification.
enum class GripEvidence : std::uint8_t {
  none,
  displacement,  ///< the finger moved less than its free-motion envelope
  pressure,      ///< weaker: only the pressure, because the displacement is not available
};
/// Returns "none", "displacement" or "pressure (weaker)".
[[nodiscard]] std::string_view name_of(GripEvidence evidence) noexcept;

}  // namespace softgrip::control
