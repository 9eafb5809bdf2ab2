#pragma once
// Compares two hypotheses by their losses on the same data. Every decision between two causes or two models
// uses this comparison.

#include <cstdint>
#include <vector>

namespace softgrip::sysid {

/// Losses of two hypotheses on the same blocks.
struct PairedLosses {
  std::vector<double> worse, better;  ///< sums of squared residuals of the two hypotheses in each block
  std::vector<double> rows;           ///< number of rows (residuals) in each block
};

struct Comparison {
  /// Share of the bootstrap samples in which the loss of `better` is smaller by more than the tolerance.
  double share = 0;
  double lower = 0, upper = 0;  ///< 95 % interval of the difference `worse` minus `better` per row
};

/// Compares the weighted mean losses per row, with random weights of the blocks (Bayesian bootstrap: Rubin,
/// Annals of Statistics 9, 1981).
/// @param tolerance  difference of the losses per row that `better` must exceed.
/// @param seed  seed of the random weights; equal seeds give equal results.
[[nodiscard]] Comparison compare(const PairedLosses& losses, double tolerance, std::uint64_t seed);

/// Returns true if `better` has the smaller loss in at least the share limits::probability of the bootstrap
/// samples. A bootstrap sample counts if the losses of `better` and `worse` differ by more than the
/// tolerance.
[[nodiscard]] bool is_better(const Comparison& comparison);

}  // namespace softgrip::sysid
