#pragma once
// Writes the units of axis labels in words, so that a figure can be read without the text of its report.

#include <string>
#include <string_view>

namespace softgrip::sysid {

/// Replaces the unit of a label by words: "time [s]" becomes "time in seconds", and "[s]" becomes "seconds".
/// A label with an unknown unit is returned unchanged.
[[nodiscard]] std::string in_words(std::string_view label);

}  // namespace softgrip::sysid
