#include "sysid/evidence/veto.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sysid/limits/limits.h"

namespace softgrip::sysid {

double largest_possible_size(const CampaignSize& range, std::string_view unit, double neutral) {
  if (neutral == 0 && unit == "mm") return range.span_mm;
  if (neutral == 0 && unit == "kPa") return range.largest_kpa;
  if (neutral == 0 && unit == "s") return range.longest_s;
  return std::numeric_limits<double>::infinity();
}

Veto veto_of(const Claim& claim) {
  if (!claim.condition_met) return Veto::not_tested;
  if (claim.size) {
    const auto& [lower, upper] = *claim.size;
    if (!excludes(*claim.size, 0)) return Veto::size_uncertain;
    // A cause is rejected only if every size in the interval is too large. Therefore the end of the interval
    // that is nearer to zero is compared with the largest possible size.
    if (std::min(std::abs(lower), std::abs(upper)) > claim.largest_size) return Veto::size_beyond_range;
  }
  if (!claim.keeps_other_sizes) return Veto::other_size_uncertain;
  if (!(claim.error_with < claim.error_without)) return Veto::error_not_reduced;
  if (claim.explained_share < limits::least_explained_share) return Veto::explains_too_little;
  if (claim.predicts_worse) return Veto::not_predictive;
  if (!claim.shown_there) return Veto::absent_where_required;
  return Veto::none;
}

std::string_view reason_of(Veto veto) {
  switch (veto) {
    case Veto::none:
      break;
    case Veto::size_uncertain:
      return "the confidence interval for the size of the effect contains zero";
    case Veto::size_beyond_range:
      return "the size of the effect exceeds the range of the signal";
    case Veto::other_size_uncertain:
      return "the effect makes the size of another cause uncertain: its confidence interval then contains "
             "zero";
    case Veto::error_not_reduced:
      return "the effect does not reduce the error of the readings";
    case Veto::explains_too_little:
      static_assert(limits::least_explained_share == 0.2);
      return "the effect explains less than 20 % of the remaining error";
    case Veto::not_predictive:
      return "the effect reduces the error on the fitted readings but increases the error on other readings";
    case Veto::not_tested:
      return "the data never meet the condition under which the effect occurs";
    case Veto::absent_where_required:
      return "the effect is absent under conditions in which the effect must occur";
  }
  return {};
}

}  // namespace softgrip::sysid
