#pragma once
// Detects an object between the fingers from the displacement shortfall: the displacement of the free-motion
// model minus the reading. The method is the same for grips to a pressure and for grips to a displacement.
// The model receives the commands that were written to the board, and it contains hysteresis and creep.
// Therefore, the shortfall is also valid while the pressure changes or the finger creeps.

#include <cstdint>
#include <limits>

namespace softgrip::control {

/// Detects contact from the displacement shortfall. Contact begins when the shortfall reaches `margin_mm`,
/// and ends when the shortfall falls below half of `margin_mm`.
class Contact {
 public:
  explicit Contact(double margin_mm) noexcept : margin_mm_(margin_mm) {}
  void reset() noexcept { touching_ = false; }
  /// Processes a displacement shortfall [mm]. If the shortfall is unknown (NaN), the state does not change.
  void observe(double shortfall_mm) noexcept;
  [[nodiscard]] bool touching() const noexcept { return touching_; }

 private:
  double margin_mm_;
  bool touching_ = false;
};

/// Decides if the evidence of a grip is present during a complete time window. A sample without a usable
/// reading restarts the window.
class EvidenceWindow {
 public:
  enum class Verdict : std::uint8_t { pending, verified, refuted };
  void start(double time_s, double window_s) noexcept;
  /// Returns `verified` if the evidence was present during the complete window. Returns `refuted` if the
  /// evidence was absent during the complete window. Returns `pending` in all other cases.
  Verdict observe(double time_s, bool usable, bool evidence) noexcept;
  /// Returns true if a sample in the last window was unusable. In this case, unusable samples may be the
  /// reason for the result `pending`.
  [[nodiscard]] bool blinded(double time_s) const noexcept { return time_s - unusable_s_ < window_s_; }

 private:
  double window_s_ = 0;
  double since_s_ = 0;                                            ///< time at which the evidence last changed
  double unusable_s_ = -std::numeric_limits<double>::infinity();  ///< time of the last unusable sample
  bool any_ = false;
  bool evidence_ = false;
};

/// Monitors a held part in successive intervals. The part counts as lost if the mean evidence of an interval
/// is below `least`. A lost part is reported after two intervals at the latest. Intervals without a usable
/// sample are ignored.
class HoldWatch {
 public:
  void start(double time_s, double interval_s, double least) noexcept;
  /// Returns true if an interval ends with this sample and shows that the part is lost.
  bool observe(double time_s, bool usable, double evidence) noexcept;

 private:
  double interval_s_ = 0;
  double least_ = 0;
  double end_s_ = 0;
  double sum_ = 0;
  std::uint32_t count_ = 0;
};

}  // namespace softgrip::control
