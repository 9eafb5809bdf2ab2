#pragma once
// Draws the start points of a search at random.

#include <cstdint>
#include <vector>

#include "model/model.h"
#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Scale of the data of a campaign.
struct CampaignSize {
  double largest_kpa = 0;  ///< largest driving pressure
  double span_mm = 0;      ///< largest span of the readings of a record
  double longest_s = 0;    ///< duration of the longest record
};
[[nodiscard]] CampaignSize campaign_size(const std::vector<Record>& records);

/// Returns `count` start points. The first is the given model. The others are drawn alternately from the
/// scale of the data (pressure, span, length) and around the given model. Parameters that are not free in
/// `space` keep their values.
[[nodiscard]] std::vector<FitPoint> draw_starts(const FitSpace& space, const FitPoint& given,
                                                const std::vector<Record>& records, std::size_t count,
                                                std::uint64_t seed);

}  // namespace softgrip::sysid
