#pragma once
// Converts values to pixels, and computes the positions of the ticks of an axis.
// Writes the units of axis labels in words, so that a figure can be read without the text of its report.

#include <string>
#include <string_view>
#include <vector>

#include "sysid/pages/chart.h"

namespace softgrip::sysid {

/// A tick of an axis: its value and its text.
struct Tick {
  double at;
  std::string text;
};

/// The mapping of the values of one axis to pixels.
class Scale {
 public:
  /// @param lowest,highest  range of the data; used if the axis has no limits of its own.
  /// @param from_px,to_px  pixel positions of the lower and the upper end of the axis.
  Scale(const Axis& axis, double lowest, double highest, double from_px, double to_px, bool with_margin);

  [[nodiscard]] double px(double value) const;
  [[nodiscard]] double lower() const { return lower_; }
  [[nodiscard]] double upper() const { return upper_; }
  /// Returns about `most` ticks or fewer, at multiples of 1, 2 or 5 times a power of ten. On a logarithmic
  /// axis, the ticks are at powers of ten; if the axis covers less than two decades, also at 2 and 5 times
  /// these powers. On an axis with categories, each category has a tick.
  [[nodiscard]] std::vector<Tick> ticks(int most) const;

 private:
  const Axis& axis_;
  double lower_;
  double upper_;
  double from_px_;
  double to_px_;
};

/// Replaces the unit of a label by words: "time [s]" becomes "time in seconds", and "[s]" becomes "seconds".
/// A label with an unknown unit is returned unchanged.
[[nodiscard]] std::string in_words(std::string_view label);

}  // namespace softgrip::sysid
