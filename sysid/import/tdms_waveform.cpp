#include "sysid/import/tdms_waveform.h"

#include <cmath>

#include "base/numbers.h"

namespace softgrip::sysid {
namespace {

/// Number of digits with which a message states a time. Two sampling intervals that differ have different
/// texts.
constexpr int shown_digits = 10;

}  // namespace

void TdmsWaveform::state(std::string_view property, double value) {
  if (property == "wf_start_offset") stated_.start_offset_s = value;
  if (property != "wf_increment") return;
  stated_.increment_s = value;
  if (!has_times()) used_.increment_s = value;
}

void TdmsWaveform::state(std::string_view property, const TdmsStamp& value) {
  if (property != "wf_start_time") return;
  stated_.start = value;
  if (!used_.start) used_.start = value;
}

bool TdmsWaveform::has_times() const {
  return used_.increment_s > 0 && std::isfinite(used_.increment_s);
}

std::string TdmsWaveform::changed_increment() const {
  constexpr double rounding = 1e-9;
  const bool is_equal =
      std::abs(stated_.increment_s - used_.increment_s) <= rounding * std::abs(used_.increment_s);
  if (!has_times() || is_equal) return {};
  return "wf_increment changes from " + significant(used_.increment_s, shown_digits) + " s to " +
         significant(stated_.increment_s, shown_digits) + " s";
}

std::string TdmsWaveform::begin_segment(std::size_t count) {
  if (count == 0) used_ = stated_;
  if (count == 0 || !has_times()) return {};
  if (std::string changed = changed_increment(); !changed.empty()) return changed;
  const double start_s = stated_.start_offset_s - used_.start_offset_s +
                         (stated_.start ? seconds_between(*used_.start, *stated_.start) : 0);
  if (start_s == stated_start_s_) return {};
  stated_start_s_ = start_s;
  const Series& last = series_.back();
  const double next_s = last.start_s + static_cast<double>(count - last.begin) * used_.increment_s;
  // The start of a continuous recording can deviate from the end of the previous segment by rounding.
  if (std::abs(start_s - next_s) <= 0.5 * used_.increment_s) return {};
  if (!(start_s > next_s))
    return "wf_start_time and wf_start_offset state that a segment begins at " +
           significant(start_s, shown_digits) + " s after the first value, but the previous values end at " +
           significant(next_s - used_.increment_s, shown_digits) + " s";
  if (last.begin == count) series_.pop_back();
  series_.push_back({count, start_s});
  return {};
}

std::string TdmsWaveform::end(std::size_t count) {
  if (series_.size() > 1 && series_.back().begin == count) series_.pop_back();
  return changed_increment();
}

double TdmsWaveform::start_s(const std::optional<TdmsStamp>& zero) const {
  return used_.start_offset_s + (zero && used_.start ? seconds_between(*zero, *used_.start) : 0);
}

std::vector<double> TdmsWaveform::times_s(std::size_t count, double start_s) const {
  std::vector<double> times_s(count);
  for (std::size_t k = 0; k < series_.size(); ++k) {
    const std::size_t end = k + 1 < series_.size() ? series_[k + 1].begin : count;
    for (std::size_t i = series_[k].begin; i < end; ++i)
      times_s[i] =
          start_s + series_[k].start_s + static_cast<double>(i - series_[k].begin) * used_.increment_s;
  }
  return times_s;
}

}  // namespace softgrip::sysid
