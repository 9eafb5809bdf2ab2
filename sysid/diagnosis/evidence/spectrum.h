#pragma once
// Computes the spectrum of a residual and tests it for a significant line.

#include <vector>

#include "sysid/diagnosis/evidence/evidence.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Computes periodograms with a Hann window and sums them over the records. About 100 frequencies are spaced
/// evenly on a logarithmic scale. The power of a line is compared with the median of its neighbourhood.
/// Therefore slow model errors do not count as lines.
/// @param structural_mm2  variance beyond the noise; 0: no shares.
[[nodiscard]] SpectrumEvidence spectrum_of(const std::vector<Record>& records,
                                           const std::vector<std::vector<double>>& residual_mm,
                                           double structural_mm2);

}  // namespace softgrip::sysid
