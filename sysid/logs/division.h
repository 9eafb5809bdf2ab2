#pragma once
// How the readings of records are divided into blocks that are held out: the only place that divides records
// and hides readings.
//
// Blocks that are held out between fitted readings are easier to predict than readings after them
// (continuation) or than a whole record. Each way has its own function.

#include <cstddef>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A contiguous stretch of one record's samples, [first, last).
struct Block {
  std::size_t record = 0;
  std::size_t first = 0;
  std::size_t last = 0;
  std::size_t fold = 0;  ///< it is held out together with the others of its fold
  /// [hidden_first, hidden_last): the block and the readings beside it that are not fitted while it is held
  /// out.
  std::size_t hidden_first = 0;
  std::size_t hidden_last = 0;
};

/// How the readings are divided. Neighbouring blocks belong to different folds.
struct Division {
  std::vector<Block> blocks;
  std::size_t folds = 2;
  double gap_s = 0;  ///< readings so near to a held-out block are not fitted either
};

/// Blocks of about `block_s`, at least eight of them; the gap is a tenth of a block.
[[nodiscard]] Division divide(const std::vector<Record>& records, double block_s);
/// Returns the blocks of the division, at the same times, for the thinned samples of `records`.
[[nodiscard]] Division thinned_like(Division division, const std::vector<Record>& records,
                                    const std::vector<Record>& thinned);
/// Ten blocks in all, at least two of each record (five of a single one), in five folds; a tenth of a block
/// on either side is not fitted.
[[nodiscard]] Division divide_into_fifths(const std::vector<Record>& records);
/// Continuation: one fold, the second half of every record in five blocks; the first halves are fitted.
[[nodiscard]] Division divide_into_halves(const std::vector<Record>& records);

/// Makes the readings of [first, last) none, and counts those that are left.
void hide_readings(Record& record, std::size_t first, std::size_t last);
/// The records with the readings of their first `share` of the samples alone: what comes after it is held
/// out.
[[nodiscard]] std::vector<Record> with_first_readings(std::vector<Record> records, double share);
/// The records without the readings that are hidden while the fold's blocks are held out.
[[nodiscard]] std::vector<Record> without_fold(std::vector<Record> records, const Division& division,
                                               std::size_t fold);

}  // namespace softgrip::sysid
