#pragma once
// Which of two hypotheses predicts better: the only rule by which one is preferred to another.

#include <cstdint>
#include <vector>

namespace softgrip::sysid {

/// Paired losses of two hypotheses, by block.
struct PairedLosses {
  std::vector<double> worse, better;  ///< sums of squares
  std::vector<double> rows;           ///< how many rows each block has
};

struct Comparison {
  double share = 0;             ///< of the draws in which `better` wins by more than the tolerance
  double lower = 0, upper = 0;  ///< 95 % interval of the difference per row
};

/// Draws weights of the blocks (Bayesian bootstrap: Rubin, Annals of Statistics 9, 1981) and compares the
/// weighted mean losses per row.
/// @param tolerance  per row. @param seed  the same seed gives the same answer.
[[nodiscard]] Comparison compare(const PairedLosses& losses, double tolerance, std::uint64_t seed);

/// Whether `better` wins by more than the tolerance as often as limits::probability asks.
[[nodiscard]] bool is_better(const Comparison& comparison);

}  // namespace softgrip::sysid
