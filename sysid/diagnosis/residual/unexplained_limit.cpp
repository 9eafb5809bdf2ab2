#include "sysid/diagnosis/residual/unexplained_limit.h"

#include <array>

namespace softgrip::sysid {
namespace {

/// Largest permitted ratio of the unexplained mean square with the causes to that of the refitted model.
constexpr double may_be_left = 0.15;
/// Stricter limits if the remaining error is clearly above the noise. Then the data contain enough
/// information to fit the complete cause, so a large remainder has another source. A smaller remainder may
/// result from the inexact form of an equation.
struct UnexplainedLimit {
  double noises;  ///< the limit applies to an error above this multiple of the noise
  double share;   ///< largest permitted ratio of the mean squares; see may_be_left
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
