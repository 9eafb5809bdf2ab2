#include "sysid/diagnosis/evidence/evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "base/numbers.h"
#include "base/statistics.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t most_samples = 12000;
constexpr std::size_t most_bins = 10;
/// Limits of the blocks: the intended length of a block as a multiple of the correlation time of the
/// residual, and the smallest number of blocks.
constexpr double memories_per_block = 8;
constexpr std::size_t fewest_blocks = 12;

/// Returns the correlation time of the residual without its white noise [s]. It is the integral of the
/// autocorrelation from the first lag on, divided by the autocorrelation at the first lag, and at least
/// interval_s.
double memory_s(const Samples& samples, const std::vector<double>& residual, double interval_s) {
  const double mean =
      std::accumulate(residual.begin(), residual.end(), 0.0) / static_cast<double>(residual.size());
  const auto correlation = [&](std::size_t lag) {
    double product = 0, variance = 0;
    for (std::size_t i = 0; i < residual.size(); ++i) {
      variance += square(residual[i] - mean);
      if (i >= lag && samples.record[i] == samples.record[i - lag])
        product += (residual[i] - mean) * (residual[i - lag] - mean);
    }
    return variance > 0 ? product / variance : 0;
  };
  const double first = correlation(1);
  if (first < 4 / std::sqrt(static_cast<double>(residual.size()))) return interval_s;
  double sum = 0;
  const std::size_t furthest = residual.size() / fewest_blocks / 2;
  // The distance between the evaluated lags grows with the lag, because the autocorrelation is smooth at
  // large lags.
  for (std::size_t lag = 1, step = 1; lag < furthest; lag += step) {
    const double r = correlation(lag) / first;
    if (r < 0.05) break;
    step = std::max<std::size_t>(1, lag / 8);
    sum += r * static_cast<double>(step);
  }
  return std::max(interval_s, sum * interval_s);
}

/// Assigns each sample to a block within its record. A block lasts about `block_s` seconds.
std::vector<std::size_t> blocks_of(const Samples& samples, double block_s, std::size_t& count) {
  std::vector<std::size_t> block(samples.size());
  count = 0;
  for (std::size_t first = 0; first < samples.size();) {
    std::size_t last = first;
    while (last < samples.size() && samples.record[last] == samples.record[first]) ++last;
    const double length_s = samples.campaign_s[last - 1] - samples.campaign_s[first];
    const auto parts = static_cast<std::size_t>(std::max(1.0, std::round(length_s / block_s)));
    for (std::size_t i = first; i < last; ++i)
      block[i] = count + std::min(parts - 1, (i - first) * parts / (last - first));
    count += parts;
    first = last;
  }
  return block;
}

/// Assigns each sample to a bin of a condition. The index none_bin means that the sample belongs to no bin.
struct Binning {
  static constexpr std::size_t none_bin = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> bin;
  std::vector<ConditionBin> bins;
};

std::vector<double> edges_of(std::vector<double> values, bool logarithmic) {
  std::sort(values.begin(), values.end());
  std::vector<double> edges;
  if (logarithmic) {
    const double low = std::log(std::max(values.front(), 1e-3 * values.back())),
                 high = std::log(values.back());
    for (std::size_t k = 1; k < most_bins; ++k)
      edges.push_back(std::exp(low + (high - low) * static_cast<double>(k) / most_bins));
  } else {
    for (std::size_t k = 1; k < most_bins; ++k) edges.push_back(values[values.size() * k / most_bins]);
  }
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  // If the first edge equals the smallest value, the bin below this edge would be empty. The edge is
  // therefore removed.
  if (!edges.empty() && edges.front() <= values.front()) edges.erase(edges.begin());
  return edges;
}

void bin_group(const Condition& c, std::size_t group, Binning& binning) {
  const auto in_group = [&](std::size_t s) {
    return std::isfinite(c.value[s]) && (c.groups.empty() || c.group[s] == group);
  };
  std::vector<double> values;
  for (std::size_t s = 0; s < c.value.size(); ++s) {
    if (in_group(s)) values.push_back(c.value[s]);
  }
  if (values.empty()) return;
  std::vector<double> edges;
  if (c.categories.empty()) {
    edges = edges_of(values, c.logarithmic);
  } else {
    for (std::size_t k = 1; k < c.categories.size(); ++k) edges.push_back(static_cast<double>(k));
  }
  const std::size_t first = binning.bins.size();
  for (std::size_t k = 0; k <= edges.size(); ++k) {
    ConditionBin bin;
    bin.group = group;
    if (!c.categories.empty()) bin.label = c.categories[k];
    binning.bins.push_back(bin);
  }
  for (std::size_t s = 0; s < c.value.size(); ++s) {
    if (!in_group(s)) continue;
    const auto above = std::upper_bound(edges.begin(), edges.end(), c.value[s]);
    binning.bin[s] = first + static_cast<std::size_t>(above - edges.begin());
    ConditionBin& bin = binning.bins[binning.bin[s]];
    bin.value += c.value[s];
    ++bin.samples;
  }
}

Binning bin(const Condition& c) {
  Binning all;
  all.bin.assign(c.value.size(), Binning::none_bin);
  for (std::size_t group = 0; group < std::max<std::size_t>(1, c.groups.size()); ++group)
    bin_group(c, group, all);
  std::vector<std::size_t> place(all.bins.size(), Binning::none_bin);
  Binning kept;
  for (std::size_t b = 0; b < all.bins.size(); ++b) {
    if (all.bins[b].samples < limits::fewest_events) continue;
    place[b] = kept.bins.size();
    kept.bins.push_back(all.bins[b]);
    kept.bins.back().value /= static_cast<double>(all.bins[b].samples);
  }
  for (const std::size_t b : all.bin) kept.bin.push_back(b == Binning::none_bin ? b : place[b]);
  return kept;
}

/// Sums of the residual for each block and bin. All tests and intervals are computed from these sums.
struct Sums {
  std::size_t bins = 0, blocks = 0;
  std::vector<double> sum;    ///< sum of the residual, with the index [block * bins + bin]
  std::vector<double> count;  ///< number of samples, with the index [block * bins + bin]

  [[nodiscard]] double total(const std::vector<double>& of, std::size_t bin) const {
    double t = 0;
    for (std::size_t b = 0; b < blocks; ++b) t += of[b * bins + bin];
    return t;
  }
};

Sums sums_of(const Binning& binning, const std::vector<double>& residual,
             const std::vector<std::size_t>& block, std::size_t blocks) {
  Sums s{binning.bins.size(), blocks, {}, {}};
  s.sum.assign(s.bins * blocks, 0.0);
  s.count.assign(s.bins * blocks, 0.0);
  for (std::size_t i = 0; i < residual.size(); ++i) {
    if (binning.bin[i] == Binning::none_bin) continue;
    s.sum[block[i] * s.bins + binning.bin[i]] += residual[i];
    s.count[block[i] * s.bins + binning.bin[i]] += 1;
  }
  return s;
}

/// Multiplies the residuals in each block by the sign of this block, and returns the sum of squares between
/// the bins.
double between(const Sums& s, const std::vector<double>& counts, const std::vector<double>& sign,
               std::vector<double>& scratch) {
  scratch.assign(s.bins, 0.0);
  for (std::size_t b = 0; b < s.blocks; ++b) {
    for (std::size_t k = 0; k < s.bins; ++k) scratch[k] += sign[b] * s.sum[b * s.bins + k];
  }
  double all = 0, samples = 0, result = 0;
  for (std::size_t k = 0; k < s.bins; ++k) {
    all += scratch[k];
    samples += counts[k];
    result += square(scratch[k]) / counts[k];
  }
  return result - square(all) / samples;
}

double sign_flip_p(const Sums& s, std::uint64_t seed) {
  std::vector<double> counts(s.bins), scratch;
  for (std::size_t k = 0; k < s.bins; ++k) counts[k] = s.total(s.count, k);
  std::vector<double> sign(s.blocks, 1.0);
  const double observed = between(s, counts, sign, scratch);
  std::mt19937_64 random(seed);
  std::size_t as_large = 0;
  for (std::size_t d = 0; d < limits::bootstrap_draws; ++d) {
    for (double& one : sign) one = (random() & 1U) != 0 ? 1.0 : -1.0;
    if (between(s, counts, sign, scratch) >= observed * (1 - 1e-12)) ++as_large;
  }
  return static_cast<double>(as_large + 1) / static_cast<double>(limits::bootstrap_draws + 1);
}

/// Returns how much the squared prediction error decreases if each residual is predicted by the mean of its
/// bin. The comparison is a prediction by the overall mean. Both means are computed from all blocks except
/// the block of the residual.
double cross_validated_gain(const Sums& s) {
  std::vector<double> sum(s.bins), count(s.bins);
  for (std::size_t k = 0; k < s.bins; ++k) {
    sum[k] = s.total(s.sum, k);
    count[k] = s.total(s.count, k);
  }
  const double all_sum = std::accumulate(sum.begin(), sum.end(), 0.0);
  const double all_count = std::accumulate(count.begin(), count.end(), 0.0);
  double gain = 0;
  for (std::size_t b = 0; b < s.blocks; ++b) {
    double block_sum = 0, block_count = 0;
    for (std::size_t k = 0; k < s.bins; ++k) {
      block_sum += s.sum[b * s.bins + k];
      block_count += s.count[b * s.bins + k];
    }
    if (block_count == 0 || block_count == all_count) continue;
    const double overall = (all_sum - block_sum) / (all_count - block_count);
    for (std::size_t k = 0; k < s.bins; ++k) {
      const double n = s.count[b * s.bins + k], here = s.sum[b * s.bins + k];
      if (n == 0) continue;
      const double rest = count[k] - n;
      const double mean = rest > 0 ? (sum[k] - here) / rest : overall;
      // In this block and bin, the reduction is the sum of (r - overall)^2 - (r - mean)^2 over the residuals
      // r.
      gain += 2 * here * (mean - overall) + n * (square(overall) - square(mean));
    }
  }
  return gain;
}

void describe_bins(const Sums& s, const Binning& binning, const std::vector<double>& residual,
                   ConditionEvidence& evidence) {
  evidence.bins = binning.bins;
  std::vector<double> squares(s.bins, 0.0);
  for (std::size_t i = 0; i < residual.size(); ++i) {
    if (binning.bin[i] != Binning::none_bin) squares[binning.bin[i]] += square(residual[i]);
  }
  for (std::size_t k = 0; k < s.bins; ++k) {
    ConditionBin& bin = evidence.bins[k];
    const double n = s.total(s.count, k);
    bin.mean_mm = s.total(s.sum, k) / n;
    bin.rms_mm = std::sqrt(squares[k] / n);
    double spread = 0, clusters = 0;
    for (std::size_t b = 0; b < s.blocks; ++b) {
      const double count = s.count[b * s.bins + k];
      if (count == 0) continue;
      clusters += 1;
      spread += square(s.sum[b * s.bins + k] - bin.mean_mm * count);
    }
    const double deviation = std::sqrt(spread * clusters / std::max(1.0, clusters - 1)) / n;
    const double half = clusters > 2 ? t_quantile(clusters - 1) * deviation : unknown;
    bin.lower_mm = bin.mean_mm - half;
    bin.upper_mm = bin.mean_mm + half;
  }
}

ConditionEvidence judge(const Condition& condition, const std::vector<double>& residual,
                        const std::vector<std::size_t>& block, std::size_t blocks, double structural,
                        std::uint64_t seed) {
  ConditionEvidence e;
  e.condition = condition;
  e.condition.value.clear();
  e.condition.group.clear();
  if (!condition.why_not.empty()) return e;
  const Binning binning = bin(condition);
  if (binning.bins.size() < 2) {
    e.condition.why_not = "constant in these logs";
    return e;
  }
  const Sums sums = sums_of(binning, residual, block, blocks);
  describe_bins(sums, binning, residual, e);
  e.p_value = sign_flip_p(sums, seed);
  if (structural > 0) e.share_percent = std::clamp(100 * cross_validated_gain(sums) / structural, 0.0, 100.0);
  return e;
}

/// Adjusts the p-values for the number of tests with Holm's step-down method.
void adjust(std::vector<ConditionEvidence>& list) {
  std::vector<ConditionEvidence*> judged;
  for (ConditionEvidence& e : list) {
    if (e.condition.why_not.empty()) judged.push_back(&e);
  }
  std::sort(judged.begin(), judged.end(),
            [](const auto* a, const auto* b) { return a->p_value < b->p_value; });
  double largest = 0;
  for (std::size_t i = 0; i < judged.size(); ++i) {
    largest = std::max(largest, judged[i]->p_value * static_cast<double>(judged.size() - i));
    judged[i]->p_adjusted = std::min(1.0, largest);
    judged[i]->clear = is_clear(judged[i]->p_adjusted, judged[i]->share_percent);
  }
}

/// Returns the sum of squared deviations. The deviation of a sample is its difference from the mean of the
/// samples in all other blocks.
double squares_about_others(const std::vector<double>& residual, const std::vector<std::size_t>& block,
                            std::size_t blocks) {
  std::vector<double> sum(blocks, 0.0), count(blocks, 0.0);
  for (std::size_t i = 0; i < residual.size(); ++i) {
    sum[block[i]] += residual[i];
    count[block[i]] += 1;
  }
  const double all = std::accumulate(sum.begin(), sum.end(), 0.0);
  const auto n = static_cast<double>(residual.size());
  double squares = 0;
  for (std::size_t i = 0; i < residual.size(); ++i) {
    const std::size_t b = block[i];
    squares += square(residual[i] - (n > count[b] ? (all - sum[b]) / (n - count[b]) : 0.0));
  }
  return squares;
}

}  // namespace

ResidualEvidence examine_residual(const std::vector<Record>& records,
                                  const std::vector<std::vector<double>>& residual_mm, const Samples& samples,
                                  const std::vector<Condition>& conditions, double noise_mm,
                                  std::uint64_t seed) {
  ResidualEvidence evidence;
  if (samples.size() < 2 * limits::fewest_events) return evidence;
  const std::vector<double> residual = pooled(samples, residual_mm);
  const auto n = static_cast<double>(residual.size());
  double length_s = 0;
  for (const Record& record : records) length_s += record.length_s();
  const double mean = std::accumulate(residual.begin(), residual.end(), 0.0) / n;
  double variance = 0, mean_square = 0;
  for (const double r : residual) {
    variance += square(r - mean) / n;
    mean_square += square(r) / n;
  }
  evidence.rms_mm = std::sqrt(mean_square);
  evidence.structure_mm = std::sqrt(std::max(0.0, mean_square - square(noise_mm)));
  evidence.memory_s = memory_s(samples, residual, length_s / n);
  evidence.block_s = std::min(
      std::max(limits::block_in_units * time_unit_s(records), memories_per_block * evidence.memory_s),
      length_s / static_cast<double>(fewest_blocks));
  const std::vector<std::size_t> block = blocks_of(samples, evidence.block_s, evidence.blocks);
  const bool present = variance > square(noise_mm) * (1 + limits::negligible_share);
  const double structural =
      present ? squares_about_others(residual, block, evidence.blocks) - n * square(noise_mm) : 0;
  for (std::size_t c = 0; c < conditions.size(); ++c)
    evidence.conditions.push_back(
        judge(conditions[c], residual, block, evidence.blocks, structural, seed * 1000003 + c));
  adjust(evidence.conditions);
  std::stable_sort(evidence.conditions.begin(), evidence.conditions.end(), [](const auto& a, const auto& b) {
    const bool judged_a = a.condition.why_not.empty(), judged_b = b.condition.why_not.empty();
    if (judged_a != judged_b) return judged_a;
    if (a.share_percent != b.share_percent) return a.share_percent > b.share_percent;
    return a.p_value < b.p_value;
  });
  evidence.spectrum = spectrum_of(records, residual_mm, present ? variance - square(noise_mm) : 0);
  return evidence;
}

Evidence examine_fits(const std::vector<Record>& records, const StructureFit& as_given,
                      const StructureFit& recalibrated, const StructureFit& extended, double noise_mm,
                      std::uint64_t seed) {
  std::vector<std::vector<double>> prediction;
  for (std::size_t k = 0; k < records.size(); ++k)
    prediction.push_back(predict(recalibrated.point.model, records[k], recalibrated.point.starts[k]));
  const Samples samples = pooled_samples(records, recalibrated.residual_mm, most_samples);
  const std::vector<Condition> conditions = conditions_of(records, prediction, samples);
  const auto examine = [&](const StructureFit& fit) {
    return examine_residual(records, fit.residual_mm, samples, conditions, noise_mm, seed);
  };
  Evidence evidence;
  evidence.as_given = examine(as_given);
  evidence.recalibrated = examine(recalibrated);
  evidence.extended =
      extended.mean_square_mm2 == recalibrated.mean_square_mm2 ? evidence.recalibrated : examine(extended);
  evidence.unphysical = unphysical_signs(recalibrated.point.model, records);
  return evidence;
}

std::string dependence_sentence(const ResidualEvidence& evidence) {
  std::string text;
  std::size_t named = 0;
  for (const ConditionEvidence& e : evidence.conditions) {
    if (!e.clear || named == 3) continue;
    text += (named == 0 ? "" : "; ") + e.condition.phrase + " (" + fixed(e.share_percent, 0) + " %)";
    ++named;
  }
  if (is_clear(evidence.spectrum.p_value, evidence.spectrum.share_percent)) {
    text += (named == 0 ? "" : "; ") + std::string("an oscillation at ") +
            significant(evidence.spectrum.peak_hz, 3) + " Hz (" + fixed(evidence.spectrum.share_percent, 0) +
            " %)";
    ++named;
  }
  if (named == 0) return "The error does not significantly depend on any condition in these logs.";
  return "The error depends on " + text +
         " (in brackets: share of the residual variance above the noise that this condition alone explains).";
}

}  // namespace softgrip::sysid
