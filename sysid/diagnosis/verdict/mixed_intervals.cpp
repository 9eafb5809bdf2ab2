#include "sysid/diagnosis/verdict/mixed_intervals.h"

#include <algorithm>
#include <optional>

#include "sysid/diagnosis/search/holdout.h"
#include "sysid/diagnosis/verdict/naming.h"

namespace softgrip::sysid {
namespace {

/// A structure that loses less in fewer than this share of the draws is ruled out.
constexpr double least_weight = 0.05;

/// What is confounded with a chosen cause and stands not beside it yet.
std::vector<Cause> confounded(const Selection& selection) {
  std::vector<Cause> list;
  for (const ChosenCause& chosen : selection.chosen) {
    for (const std::string_view id : chosen.cause.confounded_with) {
      const Cause other = *find_cause(id);
      if (!position_of(selection.extended.point.model, other) &&
          std::find(list.begin(), list.end(), other) == list.end())
        list.push_back(other);
    }
  }
  return list;
}

/// Whether any interval became wider.
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

std::vector<std::string> mix_intervals(std::vector<NamedCause>& named, const SearchData& data,
                                       const Selection& selection, const Division& division,
                                       std::uint64_t seed) {
  std::vector<std::string> sentences;
  for (const Cause& other : confounded(selection)) {
    if (!unanswerable(other, data.scales).empty()) continue;
    const std::vector<Candidate> found = fit_candidates(data, selection.extended, {.only = {other}});
    if (found.empty() || !found.front().fit) continue;
    const StructureFit& fit = *found.front().fit;
    const BlockLosses losses = held_out_losses(data.records, division, fit);
    if (winning_share(losses, selection.extended_losses, seed) < least_weight) continue;
    const FitSpace space = structure_space(data.records, fit.point.model, fit.causes);
    const UncertainPoint at = uncertain_point(data.records, fit.point, space);
    for (NamedCause& cause : named) {
      if (widen(cause, block_numbers(at, cause.block_type)))
        sentences.push_back("these logs do not say whether " + std::string(other.id) + " is there beside " +
                            std::string(cause.cause.id) + ": the intervals hold both answers");
    }
  }
  return sentences;
}

}  // namespace softgrip::sysid
