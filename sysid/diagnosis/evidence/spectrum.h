#pragma once
// Computes the spectrum of a residual and tests whether it contains a significant line.

#include <vector>

#include "sysid/diagnosis/evidence/evidence.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Sums periodograms with a Hann window over the records and returns the spectrum at about 100 frequencies,
/// spaced evenly on a logarithmic scale. The power of a line is compared with the median power at the
/// neighbouring frequencies. Slow model errors therefore do not count as lines.
/// @param structural_mm2  part of the residual's variance that exceeds the noise; 0: no share of the variance
/// is computed.
[[nodiscard]] SpectrumEvidence spectrum_of(const std::vector<Record>& records,
                                           const std::vector<std::vector<double>>& residual_mm,
                                           double structural_mm2);

}  // namespace softgrip::sysid
