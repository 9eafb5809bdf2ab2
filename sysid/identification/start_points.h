#pragma once
// Where searches begin.

#include <cstdint>
#include <vector>

#include "model/model.h"
#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// How large the numbers of a campaign are.
struct CampaignSize {
  double largest_kpa = 0;  ///< of the drive
  double span_mm = 0;      ///< the largest of a record's readings
  double longest_s = 0;    ///< of one record
};
[[nodiscard]] CampaignSize campaign_size(const std::vector<Record>& records);

/// `count` points: the given model itself; then by turns points drawn around it and points drawn from the
/// data's scale alone (pressure, span, length). Only what is free in `space` is drawn.
[[nodiscard]] std::vector<FitPoint> draw_starts(const FitSpace& space, const FitPoint& given,
                                                const std::vector<Record>& records, std::size_t count,
                                                std::uint64_t seed);

}  // namespace softgrip::sysid
