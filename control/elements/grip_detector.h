#pragma once
// Detects an object between the fingers. The evidence is the same for grips by pressure and by displacement:
// the displacement shortfall against the free model, which runs on the commands that were written. The model
// contains hysteresis and creep, so the evidence is valid while the pressure changes and creeps.

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
  /// Returns verified if the evidence held for the complete window, refuted if it was absent for a complete
  /// window.
  Verdict observe(double time_s, bool usable, bool evidence) noexcept;
  /// Returns true if a sample in the last window was not usable. A pending verdict is then due to missing
  /// readings.
  [[nodiscard]] bool blinded(double time_s) const noexcept { return time_s - unusable_s_ < window_s_; }

 private:
  double window_s_ = 0;
  double since_s_ = 0;                                            ///< time at which the evidence last changed
  double unusable_s_ = -std::numeric_limits<double>::infinity();  ///< last unusable sample
  bool any_ = false;
  bool evidence_ = false;
};

/// Monitors a held part. At the end of every interval, the mean evidence of the interval must reach the
/// minimum. A loss is reported at most two intervals after it occurs. Intervals without a usable sample are
/// ignored.
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
