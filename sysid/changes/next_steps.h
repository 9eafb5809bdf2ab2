#pragma once
// The next steps after a change: two for each cause, the quicker one first.

#include <array>
#include <string_view>
#include <vector>

#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid {

/// Empty texts for an id that is no cause.
[[nodiscard]] std::array<std::string_view, 2> next_steps(std::string_view cause_id);

/// The cause in the words of an operator: "the gain of the finger has changed".
[[nodiscard]] std::string_view plain_words(std::string_view cause_id);

/// The ids of all causes that a finger can get while it works.
[[nodiscard]] std::vector<std::string_view> changes();
/// How recorded grips show it.
[[nodiscard]] HealthSigns signs_of(std::string_view cause_id);
/// The quantity that an operator checks.
[[nodiscard]] SizedBy sized_by(std::string_view cause_id);

}  // namespace softgrip::sysid
