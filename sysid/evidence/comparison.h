#pragma once
// Compares two hypotheses by their losses on the same data. The search for changes and the conditions under
// which a cause may be named use this comparison. The bootstrap of sysid/fitting/paired_losses.h draws blocks
// instead.

#include <cstdint>
#include <vector>

namespace softgrip::sysid {

/// Losses of two hypotheses, stated separately for each block of the data.
struct PairedLosses {
  std::vector<double> worse, better;  ///< sum of squared residuals of each hypothesis in each block
  std::vector<double> rows;           ///< number of rows (residuals) in each block
};

struct Comparison {
  /// Share of the bootstrap samples in which the loss of `worse` exceeds the loss of `better` by more than
  /// the tolerance.
  double share = 0;
  double lower = 0, upper = 0;  ///< 95 % interval of the loss difference (`worse` minus `better`) per row
};

/// Compares the mean losses per row of two hypotheses by a Bayesian bootstrap over the blocks (Rubin, Annals
/// of Statistics 9, 1981). Each bootstrap sample weights the blocks randomly.
/// @param tolerance  largest loss difference per row that counts as zero.
/// @param seed  seed of the random weights; equal seeds give equal results.
[[nodiscard]] Comparison compare(const PairedLosses& losses, double tolerance, std::uint64_t seed);

/// Returns true if `better` wins in at least 95 % of the bootstrap samples (limits::probability). It wins in
/// a sample if its loss is smaller by more than the tolerance of compare().
[[nodiscard]] bool is_better(const Comparison& comparison);

}  // namespace softgrip::sysid
