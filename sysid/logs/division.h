#pragma once
// Divides the readings of records into held-out blocks. Only this file divides records or hides readings.
//
// Each validation method has its own function, because the predictions of the methods are not equally
// difficult. It is easier to predict a held-out block between fitted readings than a continuation (all
// readings after the fitted readings) or a whole record.

#include <cstddef>
#include <vector>

#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// A contiguous block of samples [first, last) of one record.
struct Block {
  std::size_t record = 0;
  std::size_t first = 0;
  std::size_t last = 0;
  std::size_t fold = 0;  ///< blocks with the same fold are held out together
  /// First sample of the range [hidden_first, hidden_last), which contains the block and the gaps beside it.
  /// No reading in this range is fitted while the block is held out.
  std::size_t hidden_first = 0;
  std::size_t hidden_last = 0;
};

/// A division of the readings of all records into held-out blocks. Adjacent blocks belong to different folds
/// if there are several folds. Each block contains at least one reading, unless no block does.
struct Division {
  std::vector<Block> blocks;
  std::size_t folds = 2;
  /// Width of the gap that divide() puts on either side of a held-out block [s]. Readings in the gap are not
  /// fitted. 0: only hidden_first and hidden_last define the gaps.
  double gap_s = 0;
};

/// Divides records into blocks of about `block_s` [s], or of 1/8 of the total duration if this is shorter.
/// The gap is 10 % of a block.
[[nodiscard]] Division divide(const std::vector<Record>& records, double block_s);
/// Returns a division of the thinned records `thinned`. Its blocks cover the same times as the blocks of
/// `division`, which divides `records`.
[[nodiscard]] Division thinned_like(Division division, const std::vector<Record>& records,
                                    const std::vector<Record>& thinned);
/// Divides records into about ten blocks in five folds. Each record has at least two blocks. In addition,
/// readings within 10 % of a block length on either side of a held-out block are not fitted.
[[nodiscard]] Division divide_into_fifths(const std::vector<Record>& records);
/// Divides records for continuation. The first half of each record is fitted. The second halves are held out
/// together (one fold), each as five blocks.
[[nodiscard]] Division divide_into_halves(const std::vector<Record>& records);

/// Removes the blocks without readings. Their error is unknown, so they must not count as blocks with the
/// error 0. If no block has readings, all blocks remain, because a division has at least one block.
void remove_unread_blocks(const std::vector<Record>& records, Division& division);
/// Removes the readings in [first, last) from a record and updates its number of readings.
void hide_readings(Record& record, std::size_t first, std::size_t last);
/// Keeps the readings in the first `share` of the samples of each record and removes all other readings.
/// Returns the resulting records.
[[nodiscard]] std::vector<Record> with_first_readings(std::vector<Record> records, double share);
/// Returns the records without the readings that must not be fitted while the blocks of the given fold are
/// held out.
[[nodiscard]] std::vector<Record> without_fold(std::vector<Record> records, const Division& division,
                                               std::size_t fold);

}  // namespace softgrip::sysid
