#pragma once
// Is there something between the fingers? One evidence for approach by pressure and by displacement: how
// much less the finger moved than the free model, run on the commands that were really sent, says it would
// have. Hysteresis and creep are in that model, so the evidence holds while the pressure changes and creeps.

#include <cstdint>
#include <limits>

namespace softgrip::control {

/// Detects contact with hysteresis. Contact starts at a displacement shortfall of `margin_mm` and ends below
/// half of it.
class Contact {
 public:
  explicit Contact(double margin_mm) noexcept : margin_mm_(margin_mm) {}
  void reset() noexcept { touching_ = false; }
  /// An unknown shortfall (NaN) changes nothing.
  void observe(double shortfall_mm) noexcept;
  [[nodiscard]] bool touching() const noexcept { return touching_; }

 private:
  double margin_mm_;
  bool touching_ = false;
};

/// Requires evidence throughout a window. Invalid readings restart the window.
class EvidenceWindow {
 public:
  enum class Verdict : std::uint8_t { pending, verified, refuted };
  void start(double time_s, double window_s) noexcept;
  /// The evidence held for the whole window: verified; held at no time of a whole window: refuted.
  Verdict observe(double time_s, bool usable, bool evidence) noexcept;
  /// Some sample of the last window said nothing: a verdict that is still pending then is pending for want of
  /// sight.
  [[nodiscard]] bool blinded(double time_s) const noexcept { return time_s - unusable_s_ < window_s_; }

 private:
  double window_s_ = 0;
  double since_s_ = 0;  ///< since when the evidence has been what it is
  double unusable_s_ = -std::numeric_limits<double>::infinity();  ///< when a sample last said nothing
  bool any_ = false;
  bool evidence_ = false;
};

/// Monitors a held part. At the end of every interval, the mean evidence of the interval must reach the
/// minimum. A loss is reported at most two intervals after it occurs. Intervals without a usable sample are
/// ignored.
class HoldWatch {
 public:
  void start(double time_s, double interval_s, double least) noexcept;
  /// True once, when the interval that just ended says that it is lost.
  bool observe(double time_s, bool usable, double evidence) noexcept;

 private:
  double interval_s_ = 0;
  double least_ = 0;
  double end_s_ = 0;
  double sum_ = 0;
  std::uint32_t count_ = 0;
};

}  // namespace softgrip::control
