#pragma once
// Checks electrically valid readings: their age, their rate of change, and the time for which they stay
// constant.

#include <cstddef>
#include <cstdint>
#include <limits>

#include "model/reading.h"

namespace softgrip::control {

/// Largest permitted value of PlausibilitySettings::unsteady_jumps.
inline constexpr std::size_t most_unsteady_jumps = 32;

struct PlausibilitySettings {
  double max_age_s = 0.05;          ///< > 0; a reading that is older than this time is stale
  double max_speed_mm_per_s = 500;  ///< > 0; no motion of the finger is faster than this speed, so a faster
                                    ///< change of the reading is a jump
  double jump_margin_mm = 0.5;      ///< >= 0; change of the reading that the sensor's noise can cause; added
                                    ///< to the change that max_speed_mm_per_s permits
  /// > 0; time for which the reading may stay constant while the command changes. This time must be longer
  /// than the valve's delay.
  double frozen_after_s = 1.0;
  double frozen_band_mm = 0;       ///< >= 0; a change of the reading up to this size (a quantisation step)
                                   ///< counts as no change
  double frozen_command_kpa = 10;  ///< > 0; a reading that is constant for frozen_after_s or longer is frozen
                                   ///< if the command has changed by at least this pressure in this time
  /// > 0; a reading is also frozen if it stays constant while the model of the free finger moves by this
  /// distance. This rule applies only while Plausibility::stands_still() returns true.
  double frozen_expected_mm = 2;
  /// > 0; a change between two readings is a jump if the model leaves more than this distance unexplained
  /// (jump_watch.h).
  double jump_mm = 2;
  /// Number of reversing jumps within 1 s that makes the sensor count as unsteady; 2 to most_unsteady_jumps.
  std::uint32_t unsteady_jumps = 4;
};

/// Checks the readings of one channel.
class Plausibility {
 public:
  explicit Plausibility(const PlausibilitySettings& settings) noexcept;

  /// Discards all earlier readings. As a result, the next valid reading is accepted at any displacement.
  void reset() noexcept;

  /// Returns the validity of `reading` at the time `now`. `command_kpa` is the last command that was sent. If
  /// the driver reports an invalid reading, returns the reason that the driver gives. A reading is a jump if
  /// it differs too much from the last valid reading. The permitted difference grows with the time since the
  /// last valid reading, so a sensor that returns after a gap becomes valid again. `expected_mm` is the
  /// displacement of the free-motion model at the time of the reading.
  [[nodiscard]] model::Validity judge(const model::Reading& reading, Nanoseconds now, double command_kpa,
                                      double expected_mm = 0) noexcept;

  /// Returns true if the readings of this sensor usually change, but the reading has now been constant much
  /// longer than ever before. A finger at rest does not cause such a constant reading, because the sensor has
  /// noise. Therefore, the sensor may be frozen. Returns false for a sensor whose readings are often constant
  /// because it is coarse, slow or without noise.
  [[nodiscard]] bool stands_still() const noexcept { return stands_still_; }

 private:
  [[nodiscard]] bool jumped(const model::Reading& reading) const noexcept;
  [[nodiscard]] bool frozen(const model::Reading& reading, double command_kpa, double expected_mm) noexcept;
  void learn(Nanoseconds run) noexcept;

  /// Smallest and largest value of a signal since the last change of the reading.
  struct Travel {
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -std::numeric_limits<double>::infinity();
    void see(double value) noexcept;
    [[nodiscard]] double length() const noexcept { return highest - lowest; }
  };

  PlausibilitySettings settings_;
  Nanoseconds max_age_;
  Nanoseconds frozen_after_;
  bool known_ = false;  ///< true: a last valid reading exists, with which the next reading is compared
  double last_mm_ = 0;
  Nanoseconds last_sampled_at_ = 0;
  bool watching_ = false;  ///< true: still_mm_ contains a displacement with which the next reading is
                           ///< compared
  double still_mm_ = 0;
  Nanoseconds still_since_ = 0;
  Travel command_kpa_;
  Travel expected_mm_;
  std::uint32_t changes_ = 0;    ///< number of changes of the reading, counted up to enough_changes
  Nanoseconds longest_run_ = 0;  ///< longest time between two changes of the reading
  bool stands_still_ = false;
};

}  // namespace softgrip::control
