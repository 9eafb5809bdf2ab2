#pragma once
// From values to pixels, and where the ticks of an axis stand.

#include <string>
#include <vector>

#include "sysid/pages/chart.h"

namespace softgrip::sysid {

/// Where a tick stands, in the axis' values, and what is written there.
struct Tick {
  double at;
  std::string text;
};

/// One axis, mapped onto pixels.
class Scale {
 public:
  /// @param lowest,highest  of the data; used where the axis sets no limit.
  /// @param from_px,to_px  where the lower and upper end stand.
  Scale(const Axis& axis, double lowest, double highest, double from_px, double to_px, bool with_margin);

  [[nodiscard]] double px(double value) const;
  [[nodiscard]] double lower() const { return lower_; }
  [[nodiscard]] double upper() const { return upper_; }
  /// At most about `most` ticks at 1, 2 or 5 times a power of ten (logarithmic: at powers of ten).
  [[nodiscard]] std::vector<Tick> ticks(int most) const;

 private:
  const Axis& axis_;
  double lower_;
  double upper_;
  double from_px_;
  double to_px_;
};

}  // namespace softgrip::sysid
