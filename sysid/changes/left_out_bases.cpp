#include "sysid/changes/left_out_bases.h"

#include <cmath>
#include <limits>
#include <utility>

#include "sysid/changes/base_prediction.h"

namespace softgrip::sysid {

std::vector<Base> left_out_bases(const Base& base) {
  std::vector<Base> bases;
  bases.reserve(base.left_out.size());
  for (const LeftOutModel& model : base.left_out) {
    bases.push_back(base);
    bases.back().model = model.model;
    bases.back().filter_weights = model.filter_weights;
  }
  return bases;
}

std::vector<LaterReadings> left_out_readings(const std::vector<Base>& bases, const std::vector<Record>& later,
                                             const std::vector<std::vector<double>>& left) {
  std::vector<LaterReadings> all;
  for (const Base& base : bases) {
    std::vector<std::vector<double>> own = residuals_of(base, later);
    for (std::size_t r = 0; r < own.size(); ++r) {
      for (std::size_t i = 0; i < own[r].size(); ++i) {
        if (std::isnan(left[r][i])) own[r][i] = std::numeric_limits<double>::quiet_NaN();
      }
    }
    all.push_back(readings_of(base, later, own));
  }
  return all;
}

}  // namespace softgrip::sysid
