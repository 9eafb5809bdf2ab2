#pragma once
// Compares two hypotheses by their losses on the same data. All decisions between two causes or models use
// it.

#include <cstdint>
#include <vector>

namespace softgrip::sysid {

/// Losses of two hypotheses on the same blocks.
struct PairedLosses {
  std::vector<double> worse, better;  ///< sums of squares
  std::vector<double> rows;           ///< number of rows of each block
};

struct Comparison {
  double share = 0;             ///< share of the draws in which `better` wins by more than the tolerance
  double lower = 0, upper = 0;  ///< 95 % interval of the difference per row
};

/// Draws weights of the blocks (Bayesian bootstrap: Rubin, Annals of Statistics 9, 1981) and compares the
/// weighted mean losses per row.
/// @param tolerance  required difference per row. @param seed  the same seed gives the same result.
[[nodiscard]] Comparison compare(const PairedLosses& losses, double tolerance, std::uint64_t seed);

/// Returns true if `better` wins by more than the tolerance in at least limits::probability of the draws.
[[nodiscard]] bool is_better(const Comparison& comparison);

}  // namespace softgrip::sysid
