#pragma once
// Locates the error of a model: the residual by condition. The tests remain valid if neighbouring errors are
// correlated.
//
// The samples are divided into blocks that are longer than the correlation time of the residual. The interval
// of a conditional mean is that of a mean of clusters (Liang and Zeger 1986). Differences between conditional
// means are tested with random signs of whole blocks (wild bootstrap, Liu 1988, on blocks). If the error does
// not depend on the condition, both signs of a block's error are equally likely. The test preserves the
// correlation inside a block and unequal variances. The share that a condition explains is evaluated on
// blocks that are not used for the means.
// blocks whose own samples are not in the means.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/evidence/conditions.h"
#include "sysid/diagnosis/search/fit.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// The residual in a narrow range of a condition.
struct ConditionBin {
  double value = 0;  ///< mean of the condition
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
  Condition condition;  ///< the condition without its samples
  std::vector<ConditionBin> bins;
  double share_percent = 0;  ///< explained share of the structural variance, on other blocks; 0 if negative
  double p_value = 1;        ///< probability of such a difference between means by chance
  double p_adjusted = 1;     ///< adjusted for testing all conditions (Holm 1979)
  bool clear = false;        ///< is_clear(p_adjusted, share_percent)
};

/// The residual by frequency.
struct SpectrumEvidence {
  std::vector<double> frequency_hz;
  std::vector<double> density_mm2_per_hz;
  double peak_hz = 0;  ///< frequency of the most significant line
  double peak_amplitude_mm = 0;
  double share_percent = 0;  ///< share of the structural variance in that line
  double p_value = 1;  ///< probability of such a line in a smooth spectrum, at any frequency (Bonferroni)
  std::string why_not;
};

/// Complete description of the residual of one model.
struct ResidualEvidence {
  double rms_mm = 0;
  double structure_mm = 0;  ///< square root of the variance beyond the noise
  double memory_s = 0;      ///< correlation time of the residual without its white part
  double block_s = 0;
  std::size_t blocks = 0;
  std::vector<ConditionEvidence> conditions;  ///< those with the largest share first, untested ones last
  SpectrumEvidence spectrum;
};

/// @param residual_mm  reading minus prediction by record; NaN without reading.
/// @param conditions  of conditions_of() for the same samples.
[[nodiscard]] ResidualEvidence examine_residual(const std::vector<Record>& records,
                                                const std::vector<std::vector<double>>& residual_mm,
                                                const Samples& samples,
                                                const std::vector<Condition>& conditions, double noise_mm,
                                                std::uint64_t seed);

/// A sign that the refit absorbed an effect outside its structure and became unphysical.
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
  ResidualEvidence extended;               ///< equal to recalibrated when nothing was added
  std::vector<UnphysicalSign> unphysical;  ///< signs in the recalibrated model
};
[[nodiscard]] Evidence examine_fits(const std::vector<Record>& records, const StructureFit& as_given,
                                    const StructureFit& recalibrated, const StructureFit& extended,
                                    double noise_mm, std::uint64_t seed);

/// "The error depends on the rate of the pressure (41 %) and ...", or that no condition is clear.
[[nodiscard]] std::string dependence_sentence(const ResidualEvidence& evidence);

}  // namespace softgrip::sysid
