#pragma once
// Finds the strongest lines in the spectrum of a residual. They are the start values for the fit of a
// sustained oscillation.

#include <cstddef>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// An oscillation sine * sin(2 pi f t) + cosine * cos(2 pi f t), where t is the time since the start of the
/// measurement campaign, plus the shift of the record.
struct Line {
  double frequency_hz = 0;
  double sine_mm = 0;
  double cosine_mm = 0;
};

/// Returns the lowest frequency of an oscillation in a measurement campaign of this length [Hz]. The campaign
/// contains 10 periods of it. A slower variation counts as a drift of the zero offset.
[[nodiscard]] inline double slowest_oscillation_hz(double campaign_s) {
  constexpr double fewest_periods = 10;
  return fewest_periods / campaign_s;
}

/// Returns the three most significant lines in the spectrum of the residual, the most significant first. The
/// spectrum is the sum of the power spectra of the records, because the phase of an oscillation is different
/// in each record. The significance of a line is the ratio of its power to the median power of the
/// neighbouring frequencies. A line is omitted if the drive has a line at the same frequency that is at least
/// half as significant, because the residual may then be a response to the drive.
/// @param residual_mm  one vector per record, as long as the record; NaN for samples without a reading.
[[nodiscard]] std::vector<Line> spectrum_peaks(const std::vector<Record>& records,
                                               const std::vector<std::vector<double>>& residual_mm);

/// The strongest lines of a residual, and for each record the shift with which these lines are stated.
struct AlignedLines {
  std::vector<Line> lines;       ///< as spectrum_peaks() returns them
  std::vector<double> shifts_s;  ///< Record::oscillation_shift_s for each record
};

/// Returns the lines of the residual, and shifts with which the strongest line has the same phase at the
/// centre of each record. With these shifts, one oscillation describes all records, and its frequency can be
/// fitted without changing the relation of the phases. All shifts are 0 if there is one record, or if noise
/// alone could cause the line with a probability of at least 1 - strict_probability.
[[nodiscard]] AlignedLines aligned_lines(const std::vector<Record>& records,
                                         const std::vector<std::vector<double>>& residual_mm);

/// Sets Record::oscillation_shift_s of each record.
void set_oscillation_shifts(std::vector<Record>& records, const std::vector<double>& shifts_s);

}  // namespace softgrip::sysid
