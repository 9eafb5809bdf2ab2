#include "sysid/diagnosis/search/scored.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/statistics.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {

bool is_free_form(const ScoredCandidate& scored) {
  return has_free_form(scored.candidate.fit->point.model, scored.candidate.cause);
}

bool ties(const ScoredCandidate& best, const ScoredCandidate& other, std::uint64_t seed) {
  return winning_share(best.losses, other.losses, seed) < limits::probability;
}

bool has_free_form(const model::Model& model, const Cause& cause) {
  return form_of(cause, model.blocks[*position_of(model, cause)]).free_form;
}

ChosenCause weigh(const Cause& cause, const ChosenBetween& between,
                  const std::vector<ScoredCandidate>& scored) {
  ChosenCause chosen = chosen_cause(cause, between.without_losses, between.with_losses, between.seed);
  const double gained = square(rmse_mm(between.without_losses)) - square(rmse_mm(between.with_losses));
  const auto indistinguishable = indistinguishable_from(cause, between.with.point.model);
  if (indistinguishable) chosen.alternatives.push_back(*indistinguishable);
  for (const ScoredCandidate& s : scored) {
    if (s.losses.empty() || s.candidate.cause == cause || !s.candidate.why_not.empty()) continue;
    if (indistinguishable && s.candidate.cause == *indistinguishable) continue;
    if (is_free_form(s)) continue;
    chosen.inclusion = std::min(chosen.inclusion, winning_share(between.with_losses, s.losses, between.seed));
    const Spread behind = mean_difference(s.losses, between.with_losses, between.seed);
    // Contact with a stiff object and a saturated sensor have nearly the same effect on the readings. They
    // differ only in the few readings that show how far the object yields.
    const bool stops = s.candidate.cause.is_stop && cause.is_stop;
    const double negligible = (stops ? 0.02 : 0.002) * between.noise_mm * between.noise_mm;
    if (behind.value <= std::max(behind.standard_error, negligible) &&
        behind.value <= std::max(limits::form_error_share * gained, negligible)) {
      chosen.alternatives.push_back(s.candidate.cause);
    }
  }
  if (indistinguishable) chosen.inclusion /= 2;
  chosen.candidates = describe(scored, between.without_losses, between.seed);
  return chosen;
}

std::vector<CandidateScore> describe(const std::vector<ScoredCandidate>& scored, const BlockLosses& before,
                                     std::uint64_t seed) {
  std::vector<CandidateScore> list;
  for (const ScoredCandidate& s : scored) {
    CandidateScore one{
        s.candidate.cause, s.candidate.why_not, 0, std::numeric_limits<double>::quiet_NaN(), {}};
    if (s.candidate.fit) one.rmse_mm = std::sqrt(s.candidate.fit->mean_square_mm2);
    if (!s.losses.empty()) {
      one.heldout_rmse_mm = rmse_mm(s.losses);
      one.gain_percent = gain_percent(before, s.losses, seed);
    }
    list.push_back(std::move(one));
  }
  return list;
}

}  // namespace softgrip::sysid
