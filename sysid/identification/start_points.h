#pragma once
// Draws random start points for the searches of a fit.

#include <cstdint>
#include <vector>

#include "model/model.h"
#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Scale of the data of all records.
struct CampaignSize {
  double largest_kpa = 0;  ///< largest magnitude of the input pressure in all records
  double span_mm = 0;      ///< largest span of the readings in a record
  double longest_s = 0;    ///< duration of the longest record
};
[[nodiscard]] CampaignSize campaign_size(const std::vector<Record>& records);

/// Returns `count` start points. The first one is the given model. The others are random points, alternately
/// at the scale of the data (pressure, span, length) and around the given model. Parameters that are not free
/// in `space` keep their values.
[[nodiscard]] std::vector<FitPoint> draw_starts(const FitSpace& space, const FitPoint& given,
                                                const std::vector<Record>& records, std::size_t count,
                                                std::uint64_t seed);

}  // namespace softgrip::sysid
