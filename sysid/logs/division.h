#pragma once
// Division of the readings of records into held-out blocks. Only this file divides records and hides
// readings.
//
// Held-out blocks between fitted readings are easier to predict than readings after the fitted ones
// (continuation), or than a whole record. Each method has its own function.

#include <cstddef>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A contiguous stretch of one record's samples, [first, last).
struct Block {
  std::size_t record = 0;
  std::size_t first = 0;
  std::size_t last = 0;
  std::size_t fold = 0;  ///< the block is held out together with the other blocks of its fold
  /// [hidden_first, hidden_last): the block and the adjacent readings that are not fitted while it is held
  /// out.
  std::size_t hidden_first = 0;
  std::size_t hidden_last = 0;
};

/// A division of the readings. Adjacent blocks belong to different folds.
struct Division {
  std::vector<Block> blocks;
  std::size_t folds = 2;
  double gap_s = 0;  ///< readings within this time of a held-out block are not fitted either [s]
};

/// Divides records into blocks of about `block_s` [s], at least eight in total. The gap is 10 % of a block.
[[nodiscard]] Division divide(const std::vector<Record>& records, double block_s);
/// Returns the blocks of the division, at the same times, for the thinned samples of `records`.
[[nodiscard]] Division thinned_like(Division division, const std::vector<Record>& records,
                                    const std::vector<Record>& thinned);
/// Divides records into about ten blocks in five folds: at least two blocks for each record, or five for a
/// single one. 10 % of a block on either side is not fitted.
[[nodiscard]] Division divide_into_fifths(const std::vector<Record>& records);
/// Divides records for continuation: one fold with the second half of each record in five blocks. The first
/// halves are fitted.
[[nodiscard]] Division divide_into_halves(const std::vector<Record>& records);

/// Removes the readings in [first, last) and updates the number of readings.
void hide_readings(Record& record, std::size_t first, std::size_t last);
/// Returns the records with only the readings of their first `share` of the samples. Later readings are held
/// out.
[[nodiscard]] std::vector<Record> with_first_readings(std::vector<Record> records, double share);
/// Returns the records without the readings that are hidden while the blocks of a fold are held out.
[[nodiscard]] std::vector<Record> without_fold(std::vector<Record> records, const Division& division,
                                               std::size_t fold);

}  // namespace softgrip::sysid
