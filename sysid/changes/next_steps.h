#pragma once
// What a person sees of a change and can do next about it: for every cause two things, the first the quicker.

#include <array>
#include <string_view>
#include <vector>

#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid {

/// Empty texts for an id that is no cause.
[[nodiscard]] std::array<std::string_view, 2> next_steps(std::string_view cause_id);

/// What the cause is, in the words of somebody who stands beside the rig: "the gain of the finger is
/// another".
[[nodiscard]] std::string_view plain_words(std::string_view cause_id);

/// The ids of all causes that a finger can get while it works.
[[nodiscard]] std::vector<std::string_view> changes();
/// How recorded grips show it.
[[nodiscard]] HealthSigns signs_of(std::string_view cause_id);
/// What somebody checks of it.
[[nodiscard]] SizedBy sized_by(std::string_view cause_id);

}  // namespace softgrip::sysid
