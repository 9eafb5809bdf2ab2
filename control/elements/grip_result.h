#pragma once
// The answer that every grip gets.

#include <cstdint>
#include <string_view>

namespace softgrip::control {

/// The result of one channel; it stays until a reset (acknowledge) or the next start.
enum class GripResult : std::uint8_t {
  none,       ///< nothing asked yet
  holding,    ///< HOLDING: an object was detected and verified
  no_part,    ///< NO PART: the finger moved as if free
  part_lost,  ///< PART LOST: it was held and is not any more
  released,   ///< RELEASED
  error,      ///< ERROR: timeout, fault or stop before an answer was there
};
/// As users read it: "HOLDING", "NO PART", "PART LOST", "RELEASED", "ERROR"; "-" for none.
[[nodiscard]] std::string_view title_of(GripResult result) noexcept;
/// As machines read it: "holding", "no_part", ...
[[nodiscard]] std::string_view name_of(GripResult result) noexcept;

/// On what a verification rests.
enum class GripEvidence : std::uint8_t {
  none,
  displacement,  ///< the finger moved less than its free-motion envelope
  pressure,      ///< weaker: pressure alone, the displacement could not be seen
};
/// "none", "displacement", "pressure (weaker)"
[[nodiscard]] std::string_view name_of(GripEvidence evidence) noexcept;

}  // namespace softgrip::control
