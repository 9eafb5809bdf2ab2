#pragma once
// What chance shows of every cause on healthy logs, and what a change must take beyond it.

#include "sysid/changes/change_search.h"

namespace softgrip::sysid {

/// The search on healthy logs, their residual taken while they were held out.
/// @param effects  effects_for() the healthy logs.
[[nodiscard]] Chance chance_of(const LaterReadings& healthy, const std::vector<Effect>& effects,
                               unsigned threads);

/// Whether an effect takes more of a reading than chance and the day make any cause of its kind take.
[[nodiscard]] bool stands_out(const ScoredEffect& scored, const Base& base);

}  // namespace softgrip::sysid
