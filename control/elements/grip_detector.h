#pragma once
// Detects an object between the fingers. Grips by pressure and grips by displacement use the same evidence:
// the displacement shortfall, which is the displacement of the free-motion model minus the reading. The model
// receives the commands that were written. It contains hysteresis and creep, so the evidence is valid while
// the pressure changes and while the finger creeps.

#include <cstdint>
#include <limits>

namespace softgrip::control {

/// Detects contact with hysteresis. Contact starts at a displacement shortfall of `margin_mm` and ends below
/// half of it.
class Contact {
 public:
  explicit Contact(double margin_mm) noexcept : margin_mm_(margin_mm) {}
  void reset() noexcept { touching_ = false; }
  /// Processes a displacement shortfall [mm]. An unknown shortfall (NaN) changes nothing.
  void observe(double shortfall_mm) noexcept;
  [[nodiscard]] bool touching() const noexcept { return touching_; }

 private:
  double margin_mm_;
  bool touching_ = false;
};

/// Decides if the evidence of a grip is present during a complete time window. Unusable readings restart the
/// window.
class EvidenceWindow {
 public:
  enum class Verdict : std::uint8_t { pending, verified, refuted };
  void start(double time_s, double window_s) noexcept;
  /// Returns verified if the evidence was present during the complete window, refuted if it was absent during
  /// the complete window, otherwise pending.
  Verdict observe(double time_s, bool usable, bool evidence) noexcept;
  /// Returns true if a sample in the last window was not usable. Missing readings are then the reason for a
  /// pending verdict.
  [[nodiscard]] bool blinded(double time_s) const noexcept { return time_s - unusable_s_ < window_s_; }

 private:
  double window_s_ = 0;
  double since_s_ = 0;                                            ///< time at which the evidence last changed
  double unusable_s_ = -std::numeric_limits<double>::infinity();  ///< time of the last unusable sample
  bool any_ = false;
  bool evidence_ = false;
};

/// Monitors a held part. The mean evidence of every interval must reach `least`. The loss of a part is
/// reported at most two intervals after it occurs. Intervals without a usable sample are ignored.
class HoldWatch {
 public:
  void start(double time_s, double interval_s, double least) noexcept;
  /// Returns true once, at the end of the interval that shows the loss.
  bool observe(double time_s, bool usable, double evidence) noexcept;

 private:
  double interval_s_ = 0;
  double least_ = 0;
  double end_s_ = 0;
  double sum_ = 0;
  std::uint32_t count_ = 0;
};

}  // namespace softgrip::control
