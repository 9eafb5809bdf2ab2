#pragma once
// What a person can do next about a change: for every cause two things, the first the quicker.

#include <array>
#include <string_view>

namespace softgrip::sysid {

/// Empty texts for an id that is no cause.
[[nodiscard]] std::array<std::string_view, 2> next_steps(std::string_view cause_id);

/// What the cause is, in the words of somebody who stands beside the rig: "the gain of the finger is
/// another".
[[nodiscard]] std::string_view plain_words(std::string_view cause_id);

}  // namespace softgrip::sysid
