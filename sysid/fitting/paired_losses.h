#pragma once
// Losses of two models on the same blocks, compared in pairs by draws of whole blocks (bootstrap).
// sysid/evidence/comparison.h compares by weights instead.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace softgrip::sysid {

/// Mean square error of every block while it was held out [mm^2].
using BlockLosses = std::vector<double>;

/// A number with its uncertainty.
struct Spread {
  double value = 0;
  double standard_error = 0;
  double lower = 0;  ///< of the 95 % interval
  double upper = 0;
};

/// A number that follows from the blocks at `indices`.
using BlockStatistic = std::function<double(std::span<const std::size_t> indices)>;
/// The statistic in every draw of as many blocks out of `blocks`, each drawn with replacement (Efron 1979).
/// Whole blocks are drawn, so that correlation within a block does not matter. The same seed gives the same
/// draws.
/// @param blocks  1 and more.
[[nodiscard]] std::vector<double> statistic_of_draws(std::size_t blocks, std::size_t draws,
                                                     std::uint64_t seed, const BlockStatistic& statistic);

/// Mean over blocks of worse minus better, with the spread of the draws.
[[nodiscard]] Spread mean_difference(const BlockLosses& worse, const BlockLosses& better, std::uint64_t seed);
/// Whether what makes the difference is missed: no draw of blocks doubts it, and it is worth `least_mm2`.
[[nodiscard]] bool is_missed(const BlockLosses& without, const BlockLosses& with, double least_mm2,
                             std::uint64_t seed);
/// Mean over blocks of log(worse / better) by the same draws: each block counts by how many times less it
/// loses, so that one in which a fit without it went astray does not outweigh all others. A block without
/// loss counts as a tie.
[[nodiscard]] Spread mean_log_ratio(const BlockLosses& worse, const BlockLosses& better, std::uint64_t seed);
/// 100 (1 - rms(after)/rms(before)) by the same draws [%].
[[nodiscard]] Spread gain_percent(const BlockLosses& before, const BlockLosses& after, std::uint64_t seed);
/// How often `ours` loses less than `other` when whole blocks are drawn in pairs; ties count half.
[[nodiscard]] double winning_share(const BlockLosses& ours, const BlockLosses& other, std::uint64_t seed);
/// Root of the mean over blocks [mm].
[[nodiscard]] double rmse_mm(const BlockLosses& losses);

/// Mean of worse minus better over blocks, and its standard error [mm^2].
struct LossDifference {
  double mean_mm2 = 0;
  double standard_error_mm2 = 0;
};
[[nodiscard]] LossDifference loss_difference(const BlockLosses& worse, const BlockLosses& better);
/// Whether less is lost by twice the standard error: in the mean over blocks, or, where that is no more, in
/// the mean of the logarithms, in which a block that is hard for both does not outweigh the others.
[[nodiscard]] bool is_clearly_less(const BlockLosses& better, const BlockLosses& worse);

}  // namespace softgrip::sysid
