#pragma once
// Converts the scores and intervals of sysid/ to the structs of the public interface.

#include <string>
#include <vector>

#include "library/include/softgrip/identify.h"
#include "sysid/fitting/interval.h"
#include "sysid/fitting/score.h"
#include "sysid/logs/record.h"

namespace softgrip::library {

[[nodiscard]] std::vector<Prediction> predictions_of(const std::vector<sysid::Record>& records,
                                                     const std::vector<sysid::Score>& scores);
[[nodiscard]] std::optional<Interval> interval_of(const std::optional<sysid::Interval>& interval);

}  // namespace softgrip::library
