#pragma once
// How many parts a MATLAB file of version 5 has, before libmatio makes an object of each.

#include <cstddef>
#include <string_view>

namespace softgrip::sysid {

/// Returns true if the cells, structures and objects of a .mat file of version 5 together have at most
/// `most_parts` data elements, and at most `most_bytes` bytes after decompression. Compressed, some kilobytes
/// can hold millions of empty cells. Arrays of numbers at the top are not counted. Broken files are: as far
/// as they can be read.
[[nodiscard]] bool mat_elements_within(std::string_view file, std::size_t most_parts, std::size_t most_bytes);

}  // namespace softgrip::sysid
