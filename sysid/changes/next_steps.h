#pragma once
// Returns the texts for an operator after a change: two next steps for each cause, the quicker one first.

#include <array>
#include <string_view>
#include <vector>

#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid {

/// Returns the next steps, or empty texts if the id is not that of a cause.
[[nodiscard]] std::array<std::string_view, 2> next_steps(std::string_view cause_id);

/// Returns the cause in words for an operator, such as "the gain of the finger has changed".
[[nodiscard]] std::string_view plain_words(std::string_view cause_id);

/// Returns the ids of all causes that can develop in operation.
[[nodiscard]] std::vector<std::string_view> changes();
/// Returns the effects of the cause on indicators of recorded grips.
[[nodiscard]] HealthSigns signs_of(std::string_view cause_id);
/// Returns the quantity that states the size of the cause.
[[nodiscard]] SizedBy sized_by(std::string_view cause_id);

}  // namespace softgrip::sysid
