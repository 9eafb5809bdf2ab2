#pragma once
// Detects which of several columns contain a motion.

#include <cstddef>
#include <span>
#include <vector>

#include "sysid/import/table.h"

namespace softgrip::sysid {

/// Returns the columns that contain a motion, in the order of `columns`. A column contains no motion if its
/// values are constant, or if they differ from sample to sample as much as over the whole file (noise), or if
/// they span less than 10 % of the values of another column in the same unit. Codes for missing values are
/// ignored.
/// @param columns  indices of columns of the table.
[[nodiscard]] std::vector<std::size_t> moving_columns(const ForeignTable& table,
                                                      std::span<const std::size_t> columns);

}  // namespace softgrip::sysid
