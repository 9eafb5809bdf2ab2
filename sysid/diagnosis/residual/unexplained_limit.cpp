#include "sysid/diagnosis/residual/unexplained_limit.h"

#include <array>

#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// Largest permitted unexplained mean square of the model with the causes, as a share of the unexplained mean
/// square of the refitted model without causes.
constexpr double may_be_left = 0.15;
/// A stricter limit for an error that is clearly above the noise. The data are then sufficient to fit the
/// complete cause, so a large remaining error has another source. A smaller remaining error may be due to the
/// approximate equation of the cause.
struct UnexplainedLimit {
  double noises;  ///< the limit applies if the error exceeds this multiple of the noise
  double share;   ///< largest permitted ratio of the mean squares, used in place of may_be_left
};
constexpr std::array unexplained_limits{UnexplainedLimit{3, limits::form_error_share},
                                        UnexplainedLimit{5, 0.02}};

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
