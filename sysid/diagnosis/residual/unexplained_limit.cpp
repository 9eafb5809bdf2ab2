#include "sysid/diagnosis/residual/unexplained_limit.h"

#include <array>

namespace softgrip::sysid {
namespace {

/// Largest share of the recalibrated model's excess mean square.
constexpr double may_be_left = 0.15;
/// Limits for a remaining error clearly above the noise. In that case the data could have shown the whole
/// cause, but did not. A smaller remainder may result from the form of an equation alone.
struct UnexplainedLimit {
  double noises;  ///< applies above this multiple of the noise
  double share;   ///< largest permitted share
};
constexpr std::array unexplained_limits{UnexplainedLimit{3, 0.05}, UnexplainedLimit{5, 0.02}};

}  // namespace

bool leaves_too_much(const UnexplainedError& left, const UnexplainedError& before, double noise_mm) {
  if (!left.present) return false;
  double may_stay = may_be_left;
  for (const UnexplainedLimit& clear : unexplained_limits) {
    if (left.excess_mm > clear.noises * noise_mm) may_stay = clear.share;
  }
  return left.excess_mm * left.excess_mm > may_stay * before.excess_mm * before.excess_mm;
}

}  // namespace softgrip::sysid
