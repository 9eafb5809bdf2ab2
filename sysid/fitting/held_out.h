#pragma once
// Cross-validates models: each model is refitted without some blocks of the readings, and its error on these
// blocks is computed. The hidden state of a model is always simulated from the start of the record. Readings
// never correct this state. The losses of two models on the same blocks are compared by a bootstrap of whole
// blocks. sysid/evidence/comparison.h, in contrast, gives the blocks random weights.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/logs/division.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Mean square error of each block [mm^2]. The fit that predicts a block did not use this block.
using BlockLosses = std::vector<double>;

/// A value with its standard error and its 95 % interval.
struct Spread {
  double value = 0;
  double standard_error = 0;
  double lower = 0;  ///< lower limit of the 95 % interval
  double upper = 0;
};

/// Function that computes a statistic from the blocks with the passed indices.
using BlockStatistic = std::function<double(std::span<const std::size_t> indices)>;
/// Returns the statistic of each bootstrap sample (Efron 1979). A bootstrap sample consists of `blocks`
/// blocks, drawn with replacement. Whole blocks are drawn, so the readings within a block may be correlated.
/// Equal seeds give equal samples. `blocks` must be at least 1.
[[nodiscard]] std::vector<double> statistic_of_draws(std::size_t blocks, std::size_t draws,
                                                     std::uint64_t seed, const BlockStatistic& statistic);

/// Returns the mean of the difference worse - better over the blocks [mm^2], with its standard error and 95 %
/// interval.
[[nodiscard]] Spread mean_difference(const BlockLosses& worse, const BlockLosses& better, std::uint64_t seed);
/// Returns true if a component of a model is necessary. The losses of the models without and with the
/// component are compared. The lower limit of the 95 % interval of mean_difference() must be above 0, and the
/// mean must exceed `least_mm2`.
[[nodiscard]] bool is_missed(const BlockLosses& without, const BlockLosses& with, double least_mm2,
                             std::uint64_t seed);
/// Returns the mean of log(worse / better) over the blocks, from the bootstrap samples of mean_difference().
/// The mean of logarithms compares ratios of losses, so one block with a very poor fit does not outweigh all
/// other blocks. A block in which one of the losses is 0 counts as a tie.
[[nodiscard]] Spread mean_log_ratio(const BlockLosses& worse, const BlockLosses& better, std::uint64_t seed);
/// Returns the error reduction 100 (1 - rms(after)/rms(before)) [%], from the bootstrap samples of
/// mean_difference().
[[nodiscard]] Spread gain_percent(const BlockLosses& before, const BlockLosses& after, std::uint64_t seed);
/// Returns the share of the bootstrap samples in which the loss of `ours` is lower than the loss of the other
/// model. Equal losses count as one half.
[[nodiscard]] double winning_share(const BlockLosses& ours, const BlockLosses& other, std::uint64_t seed);
/// Returns the square root of the mean of the losses over the blocks [mm].
[[nodiscard]] double rmse_mm(const BlockLosses& losses);

/// Mean of the difference worse - better over the blocks, and the standard error of this mean [mm^2].
struct LossDifference {
  double mean_mm2 = 0;
  double standard_error_mm2 = 0;
};
[[nodiscard]] LossDifference loss_difference(const BlockLosses& worse, const BlockLosses& better);
/// Returns true if two conditions hold: the mean loss of `better` is below the mean loss of `worse`, and the
/// 95 % interval of the difference of the losses, or of their logarithms, is above 0. With logarithms, a
/// block that is difficult for both models does not outweigh the other blocks.
[[nodiscard]] bool is_clearly_less(const BlockLosses& better, const BlockLosses& worse);

/// Function that fits a model to records from which some readings were removed. The function is called for
/// several folds in parallel.
using Refit = std::function<FitPoint(const std::vector<Record>& rest)>;

/// Returns the mean square of a residual over a block [mm^2]; 0 for a block without readings.
[[nodiscard]] double loss_of(const std::vector<double>& residual_mm, const Block& block);

/// Returns the mean square error of each block [mm^2]. The prediction comes from the model that `refit`
/// returns for the records without the fold of this block. The error is at most the square of the record's
/// span, so that a single diverging prediction does not dominate the means.
[[nodiscard]] BlockLosses held_out_losses(const std::vector<Record>& records, const Division& division,
                                          const Refit& refit);

}  // namespace softgrip::sysid
