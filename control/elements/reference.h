#pragma once
// Defines the reference of a channel in advance: a short list of segments that can be evaluated at any time.

#include <array>
#include <cstddef>
#include <cstdint>

namespace softgrip::control {

/// A reference at one time, in mm for a displacement or kPa for a pressure.
struct ReferencePoint {
  double value = 0;
  double rate = 0;          ///< per s
  double acceleration = 0;  ///< per s^2
};

/// A sequence of segments. Before the first and after the last segment, the reference is constant. Value,
/// rate and acceleration are continuous over ramps and holds (quintic, minimum jerk). The acceleration of a
/// sine begins with a step. The object is a plain value and allocates no memory. Times are seconds on the
/// caller's clock.
class Reference {
 public:
  static constexpr std::size_t capacity = 8;

  /// Holds 0 from time 0.
  Reference() noexcept = default;
  /// Discards all segments and holds `value` from `time_s` on, for example the present reading of the finger.
  void start(double time_s, double value) noexcept;
  /// Starts in motion: the first appended segment continues its rate and acceleration.
  void start(double time_s, const ReferencePoint& point) noexcept;

  // Each of the next functions appends a segment after end_s(). If `capacity` segments are still stored after
  // the last forget_before(), the function changes nothing and returns false.

  /// Appends a minimum-jerk ramp with the peak speed `speed` (> 0, per s). If the reference was cut in
  /// motion, it first brakes.
  bool ramp_to(double value, double speed) noexcept;
  /// Appends a minimum-jerk ramp of the duration `duration_s` (> 0).
  bool ramp_for(double value, double duration_s) noexcept;
  bool hold_for(double duration_s) noexcept;
  /// Appends mean - amplitude cos(2 pi f t) for `cycles`. The reference should have the value mean -
  /// amplitude before the sine.
  bool sine(double mean, double amplitude, double frequency_hz, double cycles) noexcept;

  /// Removes the part of the reference after `time_s`, so that the reference ends at `time_s`. If it had
  /// ended earlier, it holds its final value until `time_s`. The next appended segment continues with the
  /// same value, rate and acceleration. A feedforward with preview has already used the reference up to now +
  /// preview. For a change without a step, therefore cut at now + preview.
  void cut(double time_s) noexcept;
  /// Removes segments that ended before `time_s`, to make space. Earlier times then return the start value of
  /// the first segment that remains.
  void forget_before(double time_s) noexcept;

  [[nodiscard]] ReferencePoint at(double time_s) const noexcept;
  /// Returns at(time_s).value. It needs less than half of the computing time of at().
  [[nodiscard]] double value_at(double time_s) const noexcept;
  /// Returns the time at which the last segment ends. From then on the reference is constant at
  /// final_value().
  [[nodiscard]] double end_s() const noexcept;
  [[nodiscard]] double final_value() const noexcept;

 private:
  enum class Shape : std::uint8_t { quintic, sine };
  struct Segment {
    Shape shape = Shape::quintic;
    double start_s = 0;
    double duration_s = 0;
    /// quintic: coefficients of the powers of (t - start_s); sine: mean, amplitude, angular frequency
    std::array<double, 6> c{};
  };
  /// The segment at a time, and the time within this segment at which it is evaluated. Without segments, the
  /// pointer is null. `moves` is false before the first segment and after a segment has ended.
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
  Segment* append(Shape shape, double duration_s) noexcept;

  std::array<Segment, capacity> segments_{};
  std::size_t count_ = 0;
  double rest_from_s_ = 0;  ///< without segments: time from which rest_ holds
  ReferencePoint rest_{};
};

}  // namespace softgrip::control
