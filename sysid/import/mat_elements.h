#pragma once
// Counts the parts of a MATLAB file of version 5 before libmatio creates an object for each part.

#include <cstddef>
#include <string_view>

namespace softgrip::sysid {

/// Returns true if a .mat file of version 5 is within two bounds. Its cells, structures and objects together
/// have at most `most_parts` data elements, and the file has at most `most_bytes` bytes after decompression.
/// These bounds are necessary because a compressed file of a few kilobytes can contain millions of empty
/// cells. Arrays of numbers at the top level are not counted. In a damaged file, only the readable part is
/// counted.
[[nodiscard]] bool mat_elements_within(std::string_view file, std::size_t most_parts, std::size_t most_bytes);

}  // namespace softgrip::sysid
