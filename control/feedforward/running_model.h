#pragma once
// Runs the model of a channel in parallel to the finger, with the commands that were sent to the board.

#include <cstddef>
#include <vector>

#include "model/chain.h"
#include "model/model.h"

namespace softgrip::control {

/// Time after which a finger under a constant command counts as at rest, because only slow creep remains [s].
inline constexpr double rests_after_s = 3;

/// The model that runs in parallel to the finger, without its dead times. A dead time can exchange its place
/// with every time-invariant block. Therefore, the dead times are removed from the chain, and the output of
/// the chain is read with a delay. As a result, the chain runs ahead of the finger by the dead times. The
/// delayed output needs only one look-up in a table, for a dead time of any length. The state of the chain is
/// the state at which the plan of the feedforward begins.
class RunningModel {
 public:
  /// @param extra_latency_s  time from the computation of a command to the board's output.
  /// @param longest_age_s  largest age of a reading; for an older reading, the result is the oldest stored
  /// prediction.
  RunningModel(const model::Model& model, double tick_s, double extra_latency_s, double longest_age_s);

  /// Sets the state of a finger at rest under `command_kpa`.
  void reset(double command_kpa) noexcept;

  /// Advances by one tick in which the command is `command_kpa`.
  void advance(double command_kpa) noexcept;

  /// Returns the reading that the model predicts for the time `age_s` before now [mm]. Between ticks, the
  /// prediction is interpolated linearly.
  [[nodiscard]] double reading_mm(double age_s) const noexcept { return past(past_mm_, age_s); }
  /// Returns the pressure at the actuator at the time to which reading_mm(age_s) belongs [kPa].
  [[nodiscard]] double pressure_kpa(double age_s) const noexcept { return past(past_kpa_, age_s); }

  /// Returns how far the chain is ahead of the finger: the sum of the dead times and the extra latency [s].
  [[nodiscard]] double ahead_s() const noexcept { return ahead_s_; }
  /// Returns the pressure that the actuator will have in ahead_s() seconds [kPa].
  [[nodiscard]] double pressure_kpa() const noexcept { return pressure_kpa_; }
  /// Returns the valve blocks of the model without dead times, in their state in ahead_s() seconds.
  [[nodiscard]] const model::Chain<double>& valve() const noexcept { return valve_; }
  /// Returns the blocks after the valve, in their state in ahead_s() seconds.
  [[nodiscard]] const model::Chain<double>& body() const noexcept { return body_; }

 private:
  void remember() noexcept;
  [[nodiscard]] double past(const std::vector<double>& ring, double age_s) const noexcept;

  double tick_s_;
  double ahead_s_;
  bool has_valve_;
  model::Chain<double> valve_;
  model::Chain<double> body_;
  double pressure_kpa_ = 0;
  std::vector<double> past_mm_;   ///< ring buffer with one predicted reading per tick; the newest one is at
                                  ///< newest_
  std::vector<double> past_kpa_;  ///< ring buffer of the pressures at the actuator, with the indices of
                                  ///< past_mm_
  std::size_t newest_ = 0;
};

/// Returns the sum of the model's dead times [s].
[[nodiscard]] double dead_time_s(const model::Model& model);
/// valve_of() returns the valve blocks of a model that are not inverted together with the finger: lags, dead
/// bands, rate limits and saturation. body_of() returns all other blocks of the model. Both functions leave
/// out dead times and all blocks with Inverse::ignored, such as noise.
[[nodiscard]] model::Model valve_of(const model::Model& model);
[[nodiscard]] model::Model body_of(const model::Model& model);

}  // namespace softgrip::control
