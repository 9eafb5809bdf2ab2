#pragma once
// Determines from the residual of a model on which conditions its error depends. The tests remain valid if
// the errors of adjacent samples are correlated.
//
// The samples are divided into blocks that are longer than the correlation time of the residual. The
// confidence interval of a mean error treats the blocks as clusters (Liang and Zeger 1986). Differences
// between the mean errors in the bins of a condition are tested by random changes of the sign of whole blocks
// (wild bootstrap, Liu 1988). If the error does not depend on the condition, both signs of a block are
// equally likely. A change of sign keeps the correlation within a block and the variance of each block. The
// share of the variance that a condition explains is cross-validated: the means that predict a block are
// computed from the other blocks.
// Defines when an effect counts as significant. All sentences, tables and figures use this definition.
// Computes the spectrum of a residual and tests if the spectrum contains a significant line.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/evidence/conditions.h"
#include "sysid/diagnosis/search/fit.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Statistics of the residual in one bin, that is, in a narrow range of a condition.
struct ConditionBin {
  double value = 0;  ///< mean value of the condition in the bin
  std::string label;
  std::size_t group = 0;
  std::size_t samples = 0;
  double mean_mm = 0;
  double lower_mm = 0;  ///< lower end of the 95 % interval of the mean; NaN if the samples are in at most two
                        ///< blocks
  double upper_mm = 0;
  double rms_mm = 0;
};

/// Dependence of the residual of a model on one condition.
struct ConditionEvidence {
  Condition condition;  ///< tested condition; the vector of its values is empty
  std::vector<ConditionBin> bins;
  /// Residual variance that the condition explains, as a share of the residual variance that exceeds the
  /// noise; >= 0. The share is computed on held-out blocks.
  double share_percent = 0;
  /// Probability of differences between the bin means that are at least as large as the measured ones, if the
  /// error does not depend on the condition.
  double p_value = 1;
  double p_adjusted = 1;  ///< p-value adjusted for the number of tested conditions (Holm 1979)
  bool clear = false;     ///< true: the dependence is significant, that is, is_clear(p_adjusted,
                          ///< share_percent) is true
};

/// Spectrum of the residual and its most significant line.
struct SpectrumEvidence {
  std::vector<double> frequency_hz;
  std::vector<double> density_mm2_per_hz;
  double peak_hz = 0;  ///< frequency of the most significant line in the spectrum
  double peak_amplitude_mm = 0;
  double share_percent = 0;  ///< share of the residual variance above the noise that the most significant
                             ///< line contains
  /// Upper bound of the probability that a smooth spectrum has an equally significant line (Bonferroni).
  double p_value = 1;
  std::string why_not;
};

/// Analysis of the residual of one model.
struct ResidualEvidence {
  double rms_mm = 0;
  double structure_mm = 0;  ///< RMS of the unexplained error, that is, of the part of the residual above the
                            ///< noise
  double memory_s = 0;      ///< correlation time of the residual without its white noise
  double block_s = 0;
  std::size_t blocks = 0;
  /// Results for all conditions. They are sorted by the explained share, the largest first. Conditions that
  /// were not tested come last.
  std::vector<ConditionEvidence> conditions;
  SpectrumEvidence spectrum;
};

/// Analyses the residual of one model.
/// @param residual_mm  reading minus prediction, one vector per record; NaN for samples without a reading.
/// @param conditions  result of conditions_of() for `samples`.
[[nodiscard]] ResidualEvidence examine_residual(const std::vector<Record>& records,
                                                const std::vector<std::vector<double>>& residual_mm,
                                                const Samples& samples,
                                                const std::vector<Condition>& conditions, double noise_mm,
                                                std::uint64_t seed);

/// Sign that a refitted model is unphysical. The reason is usually an effect that the model structure does
/// not contain and that the parameters have absorbed.
struct UnphysicalSign {
  /// Name of the sign: "inverse_response", "stiffness_near_zero", "creep_beyond_data" or "at_bound".
  std::string name;
  std::string sentence;
  double value = 0;
  double limit = 0;
  std::string formerly = {};  ///< deprecated name of the sign; empty: none
};
[[nodiscard]] std::vector<UnphysicalSign> unphysical_signs(const model::Model& model,
                                                           const std::vector<Record>& records);

/// Analyses of the residuals of the given, the refitted and the extended model.
struct Evidence {
  ResidualEvidence as_given;
  ResidualEvidence recalibrated;
  ResidualEvidence extended;               ///< equal to `recalibrated` if the model was not extended
  std::vector<UnphysicalSign> unphysical;  ///< signs that the refitted model is unphysical
};
[[nodiscard]] Evidence examine_fits(const std::vector<Record>& records, const StructureFit& as_given,
                                    const StructureFit& recalibrated, const StructureFit& extended,
                                    double noise_mm, std::uint64_t seed);

/// Returns a sentence such as "The error depends on the rate of the pressure (41 %) ...". It lists at most
/// three conditions on which the error depends significantly, and a significant oscillation. If there is
/// none, the sentence says so.
[[nodiscard]] std::string dependence_sentence(const ResidualEvidence& evidence);

/// Returns true if an effect is significant. Only significant effects are drawn and described. The p-value
/// must be below 0.02, and the effect must explain at least 5 % of the unexplained error. For effects that
/// are tested together, pass the adjusted p-value. The limit of 0.02 leads to a significance level of about 5
/// %, because the tests reject too often in short logs whose residual has a long correlation time.
[[nodiscard]] constexpr bool is_clear(double p_value, double share_percent) {
  constexpr double once_in_fifty = 0.02;
  return p_value < once_in_fifty && share_percent >= 100 * limits::form_error_share;
}

/// Returns the spectrum of the residual at about 100 frequencies on a logarithmic scale. The spectrum is the
/// sum of the periodograms of all records with a Hann window. The power of a line is compared with the median
/// power at the neighbouring frequencies, so slow model errors do not count as lines. A line that the command
/// also contains does not count either.
/// @param structural_mm2  part of the residual variance that exceeds the noise; 0: the share of the line is
/// not computed.
[[nodiscard]] SpectrumEvidence spectrum_of(const std::vector<Record>& records,
                                           const std::vector<std::vector<double>>& residual_mm,
                                           double structural_mm2);

}  // namespace softgrip::sysid
