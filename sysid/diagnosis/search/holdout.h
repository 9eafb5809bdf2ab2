#pragma once
// Held-out evidence: structures are refitted without some contiguous stretches of the readings and judged
// there. The hidden state is always simulated from the true start, never corrected by readings.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sysid/diagnosis/search/fit.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A contiguous stretch of one record's samples, [first, last).
struct Block {
  std::size_t record = 0;
  std::size_t first = 0;
  std::size_t last = 0;
  std::size_t fold = 0;  ///< it is held out together with the others of its fold
};

/// How the readings are divided. Neighbouring blocks belong to different folds.
struct Division {
  std::vector<Block> blocks;
  std::size_t folds = 2;
  double gap_s = 0;  ///< readings so near to a held-out block are not fitted either
};

/// Of the blocks on which causes are judged: what resembles itself for longer is rare.
inline constexpr double block_length_s = 8;

/// Blocks of about `block_s`, at least eight of them; the gap is a tenth of a block.
[[nodiscard]] Division divide(const std::vector<Record>& records, double block_s);
/// The same stretches of time among the samples that are left of `records`.
[[nodiscard]] Division thinned_like(Division division, const std::vector<Record>& records,
                                    const std::vector<Record>& thinned);
/// One fold per record: whole logs are held out.
[[nodiscard]] Division divide_by_record(const std::vector<Record>& records);

/// Mean square error of every block while it was held out [mm^2].
using BlockLosses = std::vector<double>;
/// A fit that runs off where it was not fitted loses no more than one that foretells nothing: the square of
/// its record's span. What it lost would stand for nothing but itself in every mean.
[[nodiscard]] BlockLosses held_out_losses(const std::vector<Record>& records, const Division& division,
                                          const StructureFit& fit);
/// The same for a model that is not refitted.
[[nodiscard]] BlockLosses losses_of(const StructureFit& fit, const Division& division);

/// A number with its uncertainty.
struct Spread {
  double value = 0;
  double standard_error = 0;
  double lower = 0;  ///< of the 95 % interval
  double upper = 0;
};

/// Mean over blocks of worse minus better, with the spread of a bootstrap that draws whole blocks, so that
/// correlation within a block does not matter.
[[nodiscard]] Spread mean_difference(const BlockLosses& worse, const BlockLosses& better, std::uint64_t seed);
/// Whether what makes the difference is missed: no draw of blocks doubts it, and it is worth `least_mm2`.
[[nodiscard]] bool is_missed(const BlockLosses& without, const BlockLosses& with, double least_mm2,
                             std::uint64_t seed);
/// Mean over blocks of log(worse / better) by the same bootstrap: each block counts by how many times less it
/// loses, so that one in which a fit without it went astray does not outweigh all others. A block without
/// loss counts as a tie.
[[nodiscard]] Spread mean_log_ratio(const BlockLosses& worse, const BlockLosses& better, std::uint64_t seed);
/// 100 (1 - rms(after)/rms(before)) by the same bootstrap [%].
[[nodiscard]] Spread gain_percent(const BlockLosses& before, const BlockLosses& after, std::uint64_t seed);
/// How often `ours` loses less than `other` when whole blocks are drawn in pairs; ties count half.
[[nodiscard]] double winning_share(const BlockLosses& ours, const BlockLosses& other, std::uint64_t seed);
/// Root of the mean over blocks [mm].
[[nodiscard]] double rmse_mm(const BlockLosses& losses);

}  // namespace softgrip::sysid
