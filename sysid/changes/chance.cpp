#include "sysid/changes/chance.h"

#include <algorithm>

namespace softgrip::sysid {
namespace {

/// A gain is a change where it passes so many times what the cause gains on the healthy logs while they are
/// held out, and a little more.
constexpr double chance_ratio = 2.0;
/// That little, in whitened squares per second, whatever the bins, and what one cause gains on healthy logs
/// as a share of what another of its kind may gain on other days. Set on 121 unchanged worlds (of
/// --first-seed 20261126, 20261201, 20261203 and 20261204).
struct Margin {
  double finger_per_s = 0, pressure_per_s = 0, of_others = 0;
};
/// A cause that shows where the drive turns took up to 2.3 and 2.5 there.
constexpr Margin where_bases_miss{0.6, 1.5, 0.35};
/// All others up to 0.37 and 0.27.
constexpr Margin elsewhere{0.4, 0.5, 0.15};
/// A course that is drawn freely follows what the base misses on another day: it took up to 1.2, where a
/// drift of 0.15 of the usual strength took 10 and more.
constexpr Margin free_form{2, 2, 0.35};

const Margin& margin_of(const Effect& effect) {
  if (effect.free_form) return free_form;
  return effect.where_bases_miss ? where_bases_miss : elsewhere;
}

}  // namespace

Chance chance_of(const LaterReadings& healthy, const std::vector<Effect>& effects, unsigned threads) {
  const std::vector<ScoredEffect> ranked = ranked_effects(healthy, effects, {}, {}, threads);
  double largest = 0;
  for (const ScoredEffect& each : ranked) largest = std::max(largest, each.gain);
  Chance chance;
  for (const ScoredEffect& each : ranked) {
    const Effect& effect = each.fit.fitted.effect;
    chance[effect.id] = std::max(each.gain, margin_of(effect).of_others * largest);
  }
  return chance;
}

bool stands_out(const ScoredEffect& scored, const Base& base) {
  const Margin& margin = margin_of(scored.fit.fitted.effect);
  const double per_s = base.judged == Judged::pressure ? margin.pressure_per_s : margin.finger_per_s;
  return scored.gain > base.bin_s * per_s + chance_ratio * scored.chance;
}

}  // namespace softgrip::sysid
