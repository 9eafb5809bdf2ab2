#pragma once
// Determines the conditions under which a model has an error, from the residual. The tests remain valid if
// adjacent errors are correlated.
//
// The samples are divided into blocks that are longer than the correlation time of the residual. The interval
// of a conditional mean is that of a mean of clusters (Liang and Zeger 1986). Differences between conditional
// means are tested with random signs of whole blocks (wild bootstrap, Liu 1988, on blocks). If the error does
// not depend on the condition, both signs of the error of a block are equally likely. The test preserves the
// correlation inside a block and unequal variances. The share that a condition explains is computed by
// cross-validation: the means are computed without the block on which they are evaluated.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/evidence/conditions.h"
#include "sysid/diagnosis/search/fit.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// The residual in a narrow range (bin) of a condition.
struct ConditionBin {
  double value = 0;  ///< mean value of the condition in the bin
  std::string label;
  std::size_t group = 0;
  std::size_t samples = 0;
  double mean_mm = 0;
  double lower_mm = 0;  ///< 95 % interval of the mean; NaN if all samples are in one block
  double upper_mm = 0;
  double rms_mm = 0;
};

/// Dependence of a residual on one condition.
struct ConditionEvidence {
  Condition condition;  ///< the condition without its values at the samples
  std::vector<ConditionBin> bins;
  double share_percent = 0;  ///< share of the variance beyond the noise that the condition explains, on
                             ///< held-out blocks; 0 if negative
  double p_value = 1;        ///< probability that differences between the means are this large by chance
  double p_adjusted = 1;     ///< p-value adjusted for the test of all conditions (Holm 1979)
  bool clear = false;        ///< is_clear(p_adjusted, share_percent)
};

/// The spectrum of the residual.
struct SpectrumEvidence {
  std::vector<double> frequency_hz;
  std::vector<double> density_mm2_per_hz;
  double peak_hz = 0;  ///< frequency of the most significant line
  double peak_amplitude_mm = 0;
  double share_percent = 0;  ///< share of the variance beyond the noise that the line contains
  double p_value = 1;  ///< probability of such a line in a smooth spectrum, for all frequencies together
                       ///< (Bonferroni)
  std::string why_not;
};

/// Complete description of the residual of one model.
struct ResidualEvidence {
  double rms_mm = 0;
  double structure_mm = 0;  ///< square root of the residual's variance beyond the noise
  double memory_s = 0;      ///< correlation time of the residual without its white noise
  double block_s = 0;
  std::size_t blocks = 0;
  std::vector<ConditionEvidence> conditions;  ///< sorted by share, the largest first and untested conditions
                                              ///< last
  SpectrumEvidence spectrum;
};

/// Examines the residual of one model.
/// @param residual_mm  reading minus prediction, one vector per record; NaN for samples without a reading.
/// @param conditions  result of conditions_of() for the same samples.
[[nodiscard]] ResidualEvidence examine_residual(const std::vector<Record>& records,
                                                const std::vector<std::vector<double>>& residual_mm,
                                                const Samples& samples,
                                                const std::vector<Condition>& conditions, double noise_mm,
                                                std::uint64_t seed);

/// An indication that the refit has absorbed an effect outside its structure and has become unphysical.
struct UnphysicalSign {
  std::string id;  ///< "wrong_way_first", "stiffness_near_zero", "creep_beyond_data", "at_bound"
  std::string sentence;
  double value = 0;
  double limit = 0;
};
[[nodiscard]] std::vector<UnphysicalSign> unphysical_signs(const model::Model& model,
                                                           const std::vector<Record>& records);

/// The residuals of the given, refitted and extended models.
struct Evidence {
  ResidualEvidence as_given;
  ResidualEvidence recalibrated;
  ResidualEvidence extended;               ///< equal to `recalibrated` if nothing was added
  std::vector<UnphysicalSign> unphysical;  ///< indications in the recalibrated model
};
[[nodiscard]] Evidence examine_fits(const std::vector<Record>& records, const StructureFit& as_given,
                                    const StructureFit& recalibrated, const StructureFit& extended,
                                    double noise_mm, std::uint64_t seed);

/// Returns "The error depends on the rate of the pressure (41 %) and ...", or a sentence that the error
/// depends significantly on no condition.
[[nodiscard]] std::string dependence_sentence(const ResidualEvidence& evidence);

}  // namespace softgrip::sysid
