#pragma once
// Writes the units of axis labels in words, for a figure that is read without the text of its report.

#include <string>
#include <string_view>

namespace softgrip::sysid {

/// Writes the unit of a label in words: "time [s]" gives "time in seconds", "[s]" gives "seconds". An unknown
/// unit remains unchanged.
[[nodiscard]] std::string in_words(std::string_view label);

}  // namespace softgrip::sysid
