#pragma once
// Judges readings that are electrically sound: fresh, not frozen, not faster than the finger can be.

#include <cstddef>
#include <cstdint>
#include <limits>

#include "model/reading.h"

namespace softgrip::control {

/// Most of PlausibilitySettings::unsteady_jumps.
inline constexpr std::size_t most_unsteady_jumps = 32;

struct PlausibilitySettings {
  double max_age_s = 0.05;          ///< > 0; an older reading is stale
  double max_speed_mm_per_s = 500;  ///< > 0; faster than the finger can ever move
  double jump_margin_mm = 0.5;      ///< >= 0; allowed on top, for the sensor's noise
  /// > 0; how long the reading may stand still while the command moves. Longer than the delay of the valve.
  double frozen_after_s = 1.0;
  double frozen_band_mm = 0;       ///< >= 0; changes up to this are standing still (a quantisation step)
  double frozen_command_kpa = 10;  ///< > 0; the command must have travelled this far in that time
  /// > 0; or the free finger this far, where the sensor is known to be lively (Plausibility::stands_still()).
  double frozen_expected_mm = 2;
  /// > 0; from one reading to the next, beyond what the model explains, is a jump
  /// (control/elements/jump_watch.h).
  double jump_mm = 2;
  /// From 2 to most_unsteady_jumps. This number of reversing jumps within 1 s makes the sensor unsteady.
  std::uint32_t unsteady_jumps = 4;
};

/// The judge of one channel.
class Plausibility {
 public:
  explicit Plausibility(const PlausibilitySettings& settings) noexcept;

  /// Forgets everything: the next sound reading is taken as it is.
  void reset() noexcept;

  /// Returns the validity of `reading` at `now`; `command_kpa` is the last command sent. An invalidity
  /// reported by the driver is kept. A jump is measured from the last valid reading. The permitted travel
  /// grows with time, so a sensor that returns after a gap becomes valid again. `expected_mm` is the
  /// free-motion model at the time of the reading.
  [[nodiscard]] model::Validity judge(const model::Reading& reading, Nanoseconds now, double command_kpa,
                                      double expected_mm = 0) noexcept;

  /// The reading repeats itself for much longer than this sensor ever did before, whose last digits have
  /// changed all the time: it may be the sensor that stands still, and not the finger. A sensor that repeats
  /// itself anyway (coarse, slow, without noise) says nothing of the kind.
  [[nodiscard]] bool stands_still() const noexcept { return stands_still_; }

 private:
  [[nodiscard]] bool jumped(const model::Reading& reading) const noexcept;
  [[nodiscard]] bool frozen(const model::Reading& reading, double command_kpa, double expected_mm) noexcept;
  void learn(Nanoseconds run) noexcept;

  /// Extremes since the last change of the reading.
  struct Travel {
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -std::numeric_limits<double>::infinity();
    void see(double value) noexcept;
    [[nodiscard]] double length() const noexcept { return highest - lowest; }
  };

  PlausibilitySettings settings_;
  Nanoseconds max_age_;
  Nanoseconds frozen_after_;
  bool known_ = false;  ///< there is a last valid reading
  double last_mm_ = 0;
  Nanoseconds last_sampled_at_ = 0;
  bool watching_ = false;  ///< there is a displacement from which standing still is counted
  double still_mm_ = 0;
  Nanoseconds still_since_ = 0;
  Travel command_kpa_;
  Travel expected_mm_;
  std::uint32_t changes_ = 0;    ///< that were seen, as far as they are counted
  Nanoseconds longest_run_ = 0;  ///< between two of them
  bool stands_still_ = false;
};

}  // namespace softgrip::control
