#pragma once
// Divides the readings of records into held-out blocks. No other file divides records or hides readings.
//
// Each validation method has its own function, because the methods differ in difficulty. Held-out blocks
// between fitted readings are easier to predict than the readings after the fitted ones (continuation), or
// than a whole record.

#include <cstddef>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A contiguous block of samples [first, last) of one record.
struct Block {
  std::size_t record = 0;
  std::size_t first = 0;
  std::size_t last = 0;
  std::size_t fold = 0;  ///< the block is held out together with the other blocks of its fold
  /// The range [hidden_first, hidden_last) contains the block and the adjacent readings. None of them is
  /// fitted while the block is held out.
  std::size_t hidden_first = 0;
  std::size_t hidden_last = 0;
};

/// A division of the readings. Adjacent blocks belong to different folds.
struct Division {
  std::vector<Block> blocks;
  std::size_t folds = 2;
  /// Width of the gap on either side of a held-out block, in which readings are not fitted [s].
  double gap_s = 0;
};

/// Divides records into blocks of about `block_s` [s], at least eight in total. The gap is 10 % of a block.
[[nodiscard]] Division divide(const std::vector<Record>& records, double block_s);
/// Returns a division of the thinned records `thinned` with blocks at the same times as those of `division`,
/// which divides `records`.
[[nodiscard]] Division thinned_like(Division division, const std::vector<Record>& records,
                                    const std::vector<Record>& thinned);
/// Divides records into about ten blocks in five folds. Each record has at least two blocks; a single record
/// has at least five. Readings within 10 % of a block's length on either side of a held-out block are not
/// fitted either.
[[nodiscard]] Division divide_into_fifths(const std::vector<Record>& records);
/// Divides records for continuation. The first half of each record is fitted. The second half is held out as
/// one fold with five blocks.
[[nodiscard]] Division divide_into_halves(const std::vector<Record>& records);

/// Removes the readings in [first, last) and updates the number of readings.
void hide_readings(Record& record, std::size_t first, std::size_t last);
/// Returns the records with the readings of the first `share` of their samples. The other readings are
/// removed.
[[nodiscard]] std::vector<Record> with_first_readings(std::vector<Record> records, double share);
/// Returns the records without the readings that must not be fitted while the blocks of a fold are held out.
[[nodiscard]] std::vector<Record> without_fold(std::vector<Record> records, const Division& division,
                                               std::size_t fold);

}  // namespace softgrip::sysid
