#include "control/elements/grip_detector.h"

#include <cmath>

namespace softgrip::control {

void Contact::observe(double shortfall_mm) noexcept {
  if (std::isfinite(shortfall_mm)) touching_ = shortfall_mm >= (touching_ ? 0.5 * margin_mm_ : margin_mm_);
}

void EvidenceWindow::start(double time_s, double window_s) noexcept {
  window_s_ = window_s;
  since_s_ = time_s;
  unusable_s_ = -std::numeric_limits<double>::infinity();
  any_ = false;
}

EvidenceWindow::Verdict EvidenceWindow::observe(double time_s, bool usable, bool evidence) noexcept {
  if (!usable) {
    any_ = false;
    unusable_s_ = time_s;
    return Verdict::pending;
  }
  if (!any_ || evidence != evidence_) {
    any_ = true;
    evidence_ = evidence;
    since_s_ = time_s;
  }
  if (time_s - since_s_ < window_s_) return Verdict::pending;
  return evidence_ ? Verdict::verified : Verdict::refuted;
}

void HoldWatch::start(double time_s, double interval_s, double least) noexcept {
  interval_s_ = interval_s;
  least_ = least;
  end_s_ = time_s + interval_s;
  sum_ = 0;
  count_ = 0;
}

bool HoldWatch::observe(double time_s, bool usable, double evidence) noexcept {
  if (usable) {
    sum_ += evidence;
    ++count_;
  }
  if (time_s < end_s_) return false;
  const bool lost = count_ > 0 && sum_ < least_ * count_;
  start(time_s, interval_s_, least_);
  return lost;
}

}  // namespace softgrip::control
