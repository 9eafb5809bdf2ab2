#pragma once
// Returns texts for an operator after a change. There are two next steps for each cause; the quicker step
// comes first.

#include <array>
#include <string_view>
#include <vector>

#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid {

/// Returns the two next steps for a cause. The texts are empty if no cause has this id.
[[nodiscard]] std::array<std::string_view, 2> next_steps(std::string_view cause_id);

/// Returns a description of the cause for an operator, such as "the gain has changed".
[[nodiscard]] std::string_view plain_words(std::string_view cause_id);

/// Returns the ids of all causes that can develop while a finger is in operation.
[[nodiscard]] std::vector<std::string_view> changes();
/// Returns the health signs of the cause. They state which indicators of recorded grips the cause changes.
[[nodiscard]] HealthSigns signs_of(std::string_view cause_id);
/// Returns the quantity that states the size of the cause.
[[nodiscard]] SizedBy sized_by(std::string_view cause_id);

}  // namespace softgrip::sysid
