#include "sysid/logs/extent.h"

#include <algorithm>
#include <cmath>

namespace softgrip::sysid {

std::optional<ColumnExtent> extent_of(const std::vector<double>& values) {
  std::optional<ColumnExtent> extent;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    if (!extent) extent = ColumnExtent{value, value};
    extent->lowest = std::min(extent->lowest, value);
    extent->highest = std::max(extent->highest, value);
  }
  return extent;
}

}  // namespace softgrip::sysid
