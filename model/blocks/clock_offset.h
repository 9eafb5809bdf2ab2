#pragma once
// Models a sensor whose clock is behind the clock of the command. The time stamps of the readings are too
// early, so a reading seems to precede the command that causes it.

#include "model/block.h"

namespace softgrip::model {

/// Computes the reading z = y + lead dy/dt from the displacement y, with the slope of y in the last sample.
/// This formula extrapolates the motion by the time `lead`. The extrapolation is exact between two corners of
/// a piecewise linear motion. A corner of the motion appears in z by the time `lead` too late.
template <class T>
class ClockOffset {
 public:
  static constexpr BlockInfo info =
      block_info("clock_offset", Station::sensor, Kind::reading, Inverse::ignored, "Clock offset",
                 "The clock of the readings and the clock of the commands have an offset, so that the "
                 "readings appear earlier than they were sampled.",
                 "z = y + lead dy/dt");
  static constexpr std::array parameters{
      parameter("lead_s", "s", "time by which the reading leads the displacement", Typical{0.05},
                Within{0.0, 1000.0}, Scale{0.02}, Neutral{0.0}, Latency{})};

  ClockOffset(std::span<const T> values, const Preparation&) : lead_s_(values[0]) {}

  void reset(const T& input) { before_mm_ = output_ = input; }
  [[nodiscard]] T output() const { return output_; }

  T sample(const T& displacement_mm, const T& duration_s, const Surroundings&) {
    if (is_zero(duration_s)) return output_;
    output_ = displacement_mm + lead_s_ * (displacement_mm - before_mm_) / duration_s;
    before_mm_ = displacement_mm;
    return output_;
  }

 private:
  T lead_s_;
  T before_mm_{0.0};
  T output_{0.0};
};

}  // namespace softgrip::model
