#pragma once
// Defines the future reference of a channel as a short list of segments. The reference at any time is
// computed from the segments.

#include <array>
#include <cstddef>
#include <cstdint>

namespace softgrip::control {

/// Value, rate and acceleration of a reference at one time, in mm for a displacement or kPa for a pressure.
struct ReferencePoint {
  double value = 0;
  double rate = 0;          ///< change of `value` per second
  double acceleration = 0;  ///< change of `rate` per second
};

/// A sequence of segments. Before the first segment and after the last segment, the reference is constant. In
/// ramps and holds, value, rate and acceleration are continuous (quintic polynomial, minimum jerk). At the
/// start of a sine, the acceleration has a step. The class allocates no memory. Times are in seconds on the
/// clock of the caller.
class Reference {
 public:
  static constexpr std::size_t capacity = 8;

  /// Creates a reference that is constant at 0 from the time 0 on.
  Reference() noexcept = default;
  /// Discards all segments. From `time_s` on, the reference is constant at `value`. For example, `value` is
  /// the present reading of the finger.
  void start(double time_s, double value) noexcept;
  /// Starts with a moving reference: the first appended segment continues the rate and the acceleration of
  /// `point`.
  void start(double time_s, const ReferencePoint& point) noexcept;

  // Each of the following functions appends a segment after end_s(). If the list has no space for the
  // segment, or if an argument is not permitted, the function changes nothing and returns false. Arguments
  // with which a coefficient or the end of the segment would not be finite are not permitted.

  /// Appends a minimum-jerk ramp with the peak speed `speed` (> 0, per s). If the reference was cut while it
  /// moved, a braking segment is appended before the ramp.
  bool ramp_to(double value, double speed) noexcept;
  /// Appends a minimum-jerk ramp of the duration `duration_s` (> 0).
  bool ramp_for(double value, double duration_s) noexcept;
  bool hold_for(double duration_s) noexcept;
  /// Appends mean - amplitude cos(2 pi f t) for `cycles` cycles. Before the sine, the reference should be at
  /// mean - amplitude.
  bool sine(double mean, double amplitude, double frequency_hz, double cycles) noexcept;

  /// Ends the reference at `time_s` and removes its later part. If the reference ended earlier, it holds its
  /// final value until `time_s`. The next appended segment continues with the same value, rate and
  /// acceleration. A feedforward with preview has already used the reference up to now + preview. To change
  /// the reference without a step of the command, call cut(now + preview).
  void cut(double time_s) noexcept;
  /// Removes segments that ended before `time_s`, to make space for new ones. Before the first remaining
  /// segment, the reference is then constant at the start value of this segment.
  void forget_before(double time_s) noexcept;

  [[nodiscard]] ReferencePoint at(double time_s) const noexcept;
  /// Returns at(time_s).value. This function needs less than half of the computing time of at().
  [[nodiscard]] double value_at(double time_s) const noexcept;
  /// Returns the time at which the last segment ends. After this time, the reference is constant at
  /// final_value().
  [[nodiscard]] double end_s() const noexcept;
  [[nodiscard]] double final_value() const noexcept;

 private:
  enum class Shape : std::uint8_t { quintic, sine };
  struct Segment {
    Shape shape = Shape::quintic;
    double start_s = 0;
    double duration_s = 0;
    /// for a quintic: coefficients of the powers of (t - start_s); for a sine: mean, amplitude, angular
    /// frequency
    std::array<double, 6> c{};
  };
  /// The segment that contains a time, and the time within this segment. If no segments exist, the pointer is
  /// null. `moves` is false before the first segment and after the end of a segment.
  struct Place {
    const Segment* segment = nullptr;
    double time_s = 0;
    bool moves = false;
  };
  [[nodiscard]] Place place(double time_s) const noexcept;
  [[nodiscard]] double value_of(const Place& there) const noexcept;
  [[nodiscard]] static double value_of(const Segment& segment, double time_s) noexcept;
  [[nodiscard]] static ReferencePoint evaluate(const Segment& segment, double time_s) noexcept;
  [[nodiscard]] ReferencePoint last_point() const noexcept;
  bool append(Shape shape, double duration_s, const std::array<double, 6>& c) noexcept;

  std::array<Segment, capacity> segments_{};
  std::size_t count_ = 0;
  double rest_from_s_ = 0;  ///< time from which the reference is constant at rest_, if no segments exist
  ReferencePoint rest_{};
};

}  // namespace softgrip::control
