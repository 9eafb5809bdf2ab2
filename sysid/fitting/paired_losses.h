#pragma once
// Compares the losses of two models on the same blocks by a bootstrap that draws whole blocks.
// sysid/evidence/comparison.h uses random weights of the blocks instead.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace softgrip::sysid {

/// Mean square error of each block under a fit that did not use the block [mm^2].
using BlockLosses = std::vector<double>;

/// A value with its uncertainty.
struct Spread {
  double value = 0;
  double standard_error = 0;
  double lower = 0;  ///< lower limit of the 95 % interval
  double upper = 0;
};

/// Computes a statistic of the blocks with these indices.
using BlockStatistic = std::function<double(std::span<const std::size_t> indices)>;
/// Returns the statistic of each bootstrap sample (Efron 1979). A bootstrap sample consists of `blocks`
/// blocks, drawn with replacement. Because whole blocks are drawn, correlation within a block is permitted.
/// Equal seeds give equal samples.
/// @param blocks  number of blocks, at least 1.
[[nodiscard]] std::vector<double> statistic_of_draws(std::size_t blocks, std::size_t draws,
                                                     std::uint64_t seed, const BlockStatistic& statistic);

/// Returns the mean over blocks of worse minus better [mm^2], with its standard error and 95 % interval.
[[nodiscard]] Spread mean_difference(const BlockLosses& worse, const BlockLosses& better, std::uint64_t seed);
/// Returns true if the component that distinguishes the two models is necessary: the lower limit of the 95 %
/// interval of mean_difference() is above 0, and the mean exceeds `least_mm2`.
[[nodiscard]] bool is_missed(const BlockLosses& without, const BlockLosses& with, double least_mm2,
                             std::uint64_t seed);
/// Returns the mean over blocks of log(worse / better), from the same bootstrap samples as mean_difference().
/// Because ratios are used, one block with a very poor fit does not outweigh all others. A block in which a
/// loss is 0 counts as a tie.
[[nodiscard]] Spread mean_log_ratio(const BlockLosses& worse, const BlockLosses& better, std::uint64_t seed);
/// Returns the error reduction 100 (1 - rms(after)/rms(before)) [%], from the same bootstrap samples.
[[nodiscard]] Spread gain_percent(const BlockLosses& before, const BlockLosses& after, std::uint64_t seed);
/// Returns the share of the bootstrap samples in which `ours` has the lower loss. A tie counts as one half.
[[nodiscard]] double winning_share(const BlockLosses& ours, const BlockLosses& other, std::uint64_t seed);
/// Returns the square root of the mean of the losses over the blocks [mm].
[[nodiscard]] double rmse_mm(const BlockLosses& losses);

/// Mean over blocks of worse minus better, and its standard error [mm^2].
struct LossDifference {
  double mean_mm2 = 0;
  double standard_error_mm2 = 0;
};
[[nodiscard]] LossDifference loss_difference(const BlockLosses& worse, const BlockLosses& better);
/// Returns true if the mean loss of `better` is lower and the difference exceeds twice its standard error,
/// computed either from the losses or from their logarithms. With logarithms, a block that is difficult for
/// both models does not outweigh the others.
[[nodiscard]] bool is_clearly_less(const BlockLosses& better, const BlockLosses& worse);

}  // namespace softgrip::sysid
