#pragma once
// Number of parts in a MATLAB file of version 5, counted before libmatio creates an object for each part.

#include <cstddef>
#include <string_view>

namespace softgrip::sysid {

/// Returns true if a .mat file of version 5 is within two bounds: its cells, structures and objects together
/// have at most `most_parts` data elements, and it has at most `most_bytes` bytes after decompression. A
/// bound is needed because some compressed kilobytes can hold millions of empty cells. Arrays of numbers at
/// the top level are not counted. In a damaged file, the readable part is counted.
[[nodiscard]] bool mat_elements_within(std::string_view file, std::size_t most_parts, std::size_t most_bytes);

}  // namespace softgrip::sysid
