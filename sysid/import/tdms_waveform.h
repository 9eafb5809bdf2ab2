#pragma once
// Computes the times of a waveform channel of a LabVIEW TDMS file.

#include <compare>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sysid/import/tdms_value.h"

namespace softgrip::sysid {

/// Times of a waveform. Each segment of a file can state the properties wf_increment, wf_start_offset and
/// wf_start_time again.
class TdmsWaveform {
 public:
  /// A series of evenly spaced values.
  struct Series {
    std::size_t begin = 0;  ///< index of the first value
    double start_s = 0;     ///< time of the first value after the first value of the waveform
    auto operator<=>(const Series&) const = default;
  };

  /// Stores a property of a waveform. Ignores all other properties. A property that was not stated before
  /// applies to all values.
  void state(std::string_view property, double value);
  void state(std::string_view property, const TdmsStamp& value);

  /// Applies the stated properties to the values from the index `count` on. If the stated start is later than
  /// the next time of an evenly spaced series, a new series begins. Returns a sentence if the properties
  /// contradict the times of the previous values; otherwise returns an empty text.
  [[nodiscard]] std::string begin_segment(std::size_t count);
  /// Removes a series without values at the end of `count` values. Returns a sentence if the properties after
  /// the last value state another sampling interval; otherwise returns an empty text.
  [[nodiscard]] std::string end(std::size_t count);

  /// Returns true if the sampling interval is known.
  [[nodiscard]] bool has_times() const;
  [[nodiscard]] double increment_s() const { return used_.increment_s; }
  [[nodiscard]] const std::optional<TdmsStamp>& start() const { return used_.start; }
  /// Returns the time of the first value [s]. The time is relative to `zero` if both are known.
  [[nodiscard]] double start_s(const std::optional<TdmsStamp>& zero) const;
  /// Returns the series of the values. The first series begins at the index 0.
  [[nodiscard]] const std::vector<Series>& series() const { return series_; }
  /// Returns the times of `count` values [s]. The first value has the time `start_s`.
  [[nodiscard]] std::vector<double> times_s(std::size_t count, double start_s) const;

 private:
  /// Returns a sentence if the stated sampling interval differs from the sampling interval of the first
  /// value.
  [[nodiscard]] std::string changed_increment() const;

  struct Properties {
    double increment_s = 0;  ///< 0: unknown
    double start_offset_s = 0;
    std::optional<TdmsStamp> start;
  };

  Properties used_;            ///< properties of the first value
  Properties stated_;          ///< properties that the file stated last
  double stated_start_s_ = 0;  ///< start that the last segment stated, after the first value
  std::vector<Series> series_{Series{}};
};

}  // namespace softgrip::sysid
