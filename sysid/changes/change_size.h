#pragma once
// Computes the size of a change as a quantity that a technician can check.

#include <optional>

#include "sysid/changes/change.h"

namespace softgrip::sysid {

/// Returns the mean of a series over the bins in which the magnitude of the drive exceeds 90 % of its largest
/// value; 0 if there is no such bin.
[[nodiscard]] double at_full_pressure(const LaterReadings& readings, const Binned& added);

/// Returns true if the size of an effect is the sum of two gains: the gain of the effect, and the gain within
/// the spread of the healthy logs, which is fitted separately. This is the case if the effect only changes
/// the gain.
[[nodiscard]] bool is_sized_by_both_gains(const FittedEffect& effect);

/// The fit divides a gain change between the effect and the gain deviations within the spread of the healthy
/// logs. Returns the effect with the whole change, to first order in the deviations. An effect that does not
/// only change the gain or the pressure is returned unchanged.
/// @param deviation  mean relative gain deviation with this effect (LaterReadings::nuisance()).
[[nodiscard]] FittedEffect with_whole_gain(const LaterReadings& readings, FittedEffect effect,
                                           double deviation);

/// Returns the size of an effect.
/// @param full_pressure_mm  change of the displacement at full pressure that the effect causes [mm].
[[nodiscard]] ChangeSize size_of(const LaterReadings& readings, const FittedEffect& effect,
                                 double full_pressure_mm);

/// Size that states a change, and its evidence.
struct ShownSize {
  ChangeSize size;
  std::optional<Interval> interval;  ///< 95 % interval of `size`; empty: the data do not determine the size
  double neutral = 0;                ///< value of `size` without the change
};

/// Returns the size of an effect with its interval. The effect at full pressure does not state the size of an
/// effect that vanishes there, such as an oscillation. If the effect at full pressure is not significant or
/// smaller than the RMS of the effect, the result is therefore the most significant parameter with a neutral
/// value, if its interval excludes this value. A parameter that only defines the reference of the effect is
/// not used.
/// @param intervals  intervals of the effect: an element of intervals_of().
[[nodiscard]] ShownSize shown_size(const LaterReadings& readings, const FittedEffect& effect,
                                   const EffectIntervals& intervals);

}  // namespace softgrip::sysid
