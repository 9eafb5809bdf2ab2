#pragma once
// Detects that a value is at rest because it has stayed within a band for a required time.

#include <algorithm>
#include <optional>

namespace softgrip::control {

class RestWatch {
 public:
  RestWatch(double band, double time_s) noexcept : band_(band), time_s_(time_s) {}

  void start() noexcept { seen_.reset(); }

  /// Processes one tick. Returns true if `value` has stayed within the band for the required time. An empty
  /// `value` means that the value is unknown; the required time then restarts.
  bool observe(double time_s, std::optional<double> value) noexcept {
    if (!value) {
      start();
      return false;
    }
    if (seen_) {
      seen_->lowest = std::min(seen_->lowest, *value);
      seen_->highest = std::max(seen_->highest, *value);
    }
    if (!seen_ || seen_->highest - seen_->lowest > band_) seen_ = {*value, *value, time_s};
    return time_s - seen_->since_s >= time_s_;
  }

 private:
  struct Seen {
    double lowest;
    double highest;
    double since_s;
  };
  double band_;
  double time_s_;
  std::optional<Seen> seen_;
};

}  // namespace softgrip::control
