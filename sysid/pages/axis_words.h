#pragma once
// Units in words, for those who read a figure without its text.

#include <string>
#include <string_view>

namespace softgrip::sysid {

/// "time [s]" as "time in seconds", "[s]" as "seconds"; a unit that is not known stays as it is.
[[nodiscard]] std::string in_words(std::string_view label);

}  // namespace softgrip::sysid
