#pragma once
// Interleaved blocks: contiguous stretches of readings that are held out in turn. What is held out this way
// lies between what was fitted; what comes after it (continuation) is a harder question and has its own name
// wherever it is printed.

#include <cstddef>
#include <vector>

#include "sysid/fitting/fit_space.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

class HeldOutBlocks {
 public:
  static constexpr std::size_t folds = 5;

  explicit HeldOutBlocks(const std::vector<Record>& records);

  [[nodiscard]] std::size_t count() const { return blocks_.size(); }
  /// The records without the readings of a fold's blocks, nor those within a tenth of a block beside them.
  [[nodiscard]] const std::vector<Record>& without(std::size_t fold) const { return fitted_[fold]; }
  /// Fills in the mean square of the fold's blocks under a model that was fitted without them [mm^2].
  void judge(const FitPoint& point, std::size_t fold, std::vector<double>& losses_mm2) const;

 private:
  struct Block {
    std::size_t record, first, last;
  };

  const std::vector<Record>& records_;
  std::vector<Block> blocks_;
  std::vector<std::vector<Record>> fitted_;  ///< by fold
};

/// Continuation: the first half of every record is fitted, the second judged. With few cycles of data what
/// lies between fitted readings flatters a model that only follows them.
class HeldOutContinuation {
 public:
  explicit HeldOutContinuation(const std::vector<Record>& records);
  [[nodiscard]] const std::vector<Record>& first_half() const { return fitted_; }
  /// Mean squares of contiguous parts of the second halves under a model that was fitted to the first [mm^2].
  [[nodiscard]] std::vector<double> judge(const FitPoint& point) const;

 private:
  const std::vector<Record>& records_;
  std::vector<Record> fitted_;
};

/// Root of the mean over blocks [mm].
[[nodiscard]] double held_out_rmse_mm(const std::vector<double>& losses_mm2);

/// Mean of worse minus better over blocks, and its standard error [mm^2].
struct LossDifference {
  double mean_mm2 = 0;
  double standard_error_mm2 = 0;
};
[[nodiscard]] LossDifference loss_difference(const std::vector<double>& worse,
                                             const std::vector<double>& better);
/// Whether less is lost by twice the standard error: in the mean over blocks, or, where that is no more, in
/// the mean of the logarithms, in which a block that is hard for both does not outweigh the others.
[[nodiscard]] bool is_clearly_less(const std::vector<double>& better, const std::vector<double>& worse);

}  // namespace softgrip::sysid
