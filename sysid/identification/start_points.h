#pragma once
// Where searches begin.

#include <cstdint>
#include <vector>

#include "model/model.h"
#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// `count` points: the given model itself; then by turns points drawn around it and points drawn from the
/// data's scale alone (pressure, span, length). Only what is free in `space` is drawn.
[[nodiscard]] std::vector<FitPoint> draw_starts(const FitSpace& space, const FitPoint& given,
                                                const std::vector<Record>& records, std::size_t count,
                                                std::uint64_t seed);

}  // namespace softgrip::sysid
