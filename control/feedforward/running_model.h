#pragma once
// The model of a channel run beside the finger on the command that was really sent.

#include <cstddef>
#include <vector>

#include "model/chain.h"
#include "model/model.h"

namespace softgrip::control {

/// Time at a constant command after which a finger is at rest: only slow creep remains [s].
inline constexpr double rests_after_s = 3;

/// Dead times commute with everything that does not change with time, so they are taken out of the chain: it
/// runs without them, ahead of the finger, and the past is looked up. That makes a delay of any length one
/// look-up, and gives the feedforward the state in which its plan begins.
class RunningModel {
 public:
  /// @param extra_latency_s  from the computation of a command to the board's output.
  /// @param longest_age_s  largest age of a reading; an older one gets the oldest stored prediction.
  RunningModel(const model::Model& model, double tick_s, double extra_latency_s, double longest_age_s);

  /// At rest under `command_kpa`.
  void reset(double command_kpa) noexcept;

  /// One tick of `command_kpa` held.
  void advance(double command_kpa) noexcept;

  /// The reading that the model expects `age_s` ago [mm]. Straight between ticks.
  [[nodiscard]] double reading_mm(double age_s) const noexcept { return past(past_mm_, age_s); }
  /// The pressure at the actuator under which it expected that [kPa].
  [[nodiscard]] double pressure_kpa(double age_s) const noexcept { return past(past_kpa_, age_s); }

  /// How far the chain runs ahead of the finger: dead times and extra latency [s].
  [[nodiscard]] double ahead_s() const noexcept { return ahead_s_; }
  /// Pressure at the actuator, ahead_s() from now [kPa].
  [[nodiscard]] double pressure_kpa() const noexcept { return pressure_kpa_; }
  /// The valve without its dead times, ahead_s() from now.
  [[nodiscard]] const model::Chain<double>& valve() const noexcept { return valve_; }
  /// Everything behind the valve, ahead_s() from now.
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
  std::vector<double> past_mm_;   ///< a ring, one entry per tick, newest at newest_
  std::vector<double> past_kpa_;  ///< another, beside it
  std::size_t newest_ = 0;
};

/// The sum of the model's dead times [s].
[[nodiscard]] double dead_time_s(const model::Model& model);
/// The model without dead times and without what is only noise: what takes time to follow the command, and
/// everything behind it.
[[nodiscard]] model::Model valve_of(const model::Model& model);
[[nodiscard]] model::Model body_of(const model::Model& model);

}  // namespace softgrip::control
