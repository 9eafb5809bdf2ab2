#include "sysid/diagnosis/verdict/mixed_intervals.h"

#include <algorithm>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/verdict/naming.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// Widens the interval of each parameter of `named` so that it covers the interval of the same parameter in
/// `with`. Returns true if an interval became wider.
bool widen(NamedCause& named, const std::vector<CauseParameter>& with) {
  bool wider = false;
  for (CauseParameter& number : named.parameters) {
    const auto same = std::find_if(with.begin(), with.end(),
                                   [&](const CauseParameter& p) { return p.name == number.name; });
    if (!number.has_interval || same == with.end() || !same->has_interval) continue;
    wider |= same->ci95.lower < number.ci95.lower || same->ci95.upper > number.ci95.upper;
    number.ci95 = {std::min(number.ci95.lower, same->ci95.lower),
                   std::max(number.ci95.upper, same->ci95.upper)};
  }
  return wider;
}

}  // namespace

std::vector<std::string> mix_intervals(std::vector<NamedCause>& named, const std::vector<Record>& records,
                                       const Selection& selection, std::uint64_t seed) {
  std::vector<std::string> sentences;
  for (const Confounded& other : selection.undecided) {
    if (winning_share(other.losses, selection.extended_losses, seed) < 1 - limits::probability) continue;
    const FitSpace space = structure_space(records, other.fit.point.model, other.fit.causes);
    const UncertainPoint at = uncertain_point(records, other.fit.point, space);
    std::string beside;
    for (NamedCause& cause : named) {
      if (!widen(cause, block_numbers(at, cause.block_type)) || !cause.cause.is_confounded_with(other.cause))
        continue;
      beside += (beside.empty() ? "" : " and ") + std::string(cause.cause.id);
    }
    if (!beside.empty()) {
      sentences.push_back("these logs do not determine whether " + std::string(other.cause.id) +
                          " is present in addition to " + beside + ", so the intervals cover both cases");
    }
  }
  return sentences;
}

}  // namespace softgrip::sysid
