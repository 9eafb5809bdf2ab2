#pragma once
// Defines the reference of a channel, known in advance: a short list of segments that can be evaluated at any
// time.

#include <array>
#include <cstddef>
#include <cstdint>

namespace softgrip::control {

/// A reference at one moment. The unit is the channel mode's: mm when a displacement is tracked, kPa when a
/// pressure is.
struct ReferencePoint {
  double value = 0;
  double rate = 0;          ///< per s
  double acceleration = 0;  ///< per s^2
};

/// Segments one after another; before the first and after the last it holds. Value, rate and acceleration
/// are continuous over ramps and holds (quintic, minimum jerk); a sine starts with its acceleration at once.
/// Plain value, no allocation. Times are seconds on the caller's clock.
class Reference {
 public:
  static constexpr std::size_t capacity = 8;

  /// Holds 0 from time 0.
  Reference() noexcept = default;
  /// Forgets everything and holds `value` from `time_s` on. To start from where the finger is: its reading.
  void start(double time_s, double value) noexcept;
  /// Starts in motion: the first appended segment continues its rate and acceleration.
  void start(double time_s, const ReferencePoint& point) noexcept;

  // Each of the next appends behind end_s() and returns false, changing nothing, when `capacity` segments
  // lie in the future of the last forget_before().

  /// Minimum-jerk ramp whose peak speed is `speed` (> 0, per s). After a cut() in motion it brakes first.
  bool ramp_to(double value, double speed) noexcept;
  /// Minimum-jerk ramp that takes `duration_s` (> 0).
  bool ramp_for(double value, double duration_s) noexcept;
  bool hold_for(double duration_s) noexcept;
  /// mean - amplitude cos(2 pi f t) for `cycles`; ramp to mean - amplitude before it.
  bool sine(double mean, double amplitude, double frequency_hz, double cycles) noexcept;

  /// Removes everything after `time_s` and ends there (holding until then if it ended before). The next
  /// appended segment continues with the same value, rate and acceleration. A feedforward with preview has
  /// already used the reference up to its preview. Therefore cut at now + preview for a change without a
  /// step.
  void cut(double time_s) noexcept;
  /// Makes room: segments that ended before `time_s` are dropped; earlier times then return the value where
  /// the first one left starts.
  void forget_before(double time_s) noexcept;

  [[nodiscard]] ReferencePoint at(double time_s) const noexcept;
  /// at(time_s).value, for less than half of the work.
  [[nodiscard]] double value_at(double time_s) const noexcept;
  /// When the last segment ends; from then on final_value() is held.
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
  /// Where a time falls: on a segment that moves, at the end of one that is over, or on none (nullptr).
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
  double rest_from_s_ = 0;  ///< without segments: since when rest_ holds
  ReferencePoint rest_{};
};

}  // namespace softgrip::control
