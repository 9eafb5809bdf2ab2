#pragma once
// Estimates by how much time the readings react before the command changes.

#include <optional>
#include <vector>

#include "sysid/diagnosis/search/selection.h"
#include "sysid/fitting/interval.h"

namespace softgrip::sysid {

struct ReadingLead {
  double lead_s = 0;
  /// 95 % interval of the lead. It is computed from the mean square error as a function of the lead. For each
  /// value of the lead, all parameters of the structure are refitted. The interval takes the correlation of
  /// the residual into account.
  Interval ci95;
};

struct LeadFit {
  ReadingLead lead;
  StructureFit fit;
  std::vector<Record> records;  ///< records whose drive is shifted by the lead
};

/// Returns the records with their drive shifted to an earlier time by `lead_s`. The first sample keeps its
/// drive, because this drive defines the initial state of the record. Its reading becomes NaN, and the first
/// step lasts longer by `lead_s`. If the shifted drive of a sample would lie after the end of the record, the
/// reading of the sample becomes NaN.
[[nodiscard]] std::vector<Record> with_drive_ahead(std::vector<Record> records, double lead_s);

/// Determines the lead accurately if the cause clock_offset is possible. The block of this cause extrapolates
/// the motion and is inaccurate at corners, but a shift of the drive is exact. The cause is possible if the
/// selection contains it. It is also possible if the selection leaves an unexplained error and the block
/// reduces the held-out error of the base structure. A long lead makes the block so inaccurate that the
/// search may prefer another cause. Returns nullopt in three cases:
/// - The cause is not possible.
/// - The 95 % interval of the lead contains zero.
/// - The shifted drive leaves a larger error than the causes of the selection. If the selection does not
///   contain the cause, the shifted drive must remove at least 75 % of the remaining mean square.
[[nodiscard]] std::optional<LeadFit> fit_lead(const SearchData& data, const Selection& selection,
                                              double noise_mm);

}  // namespace softgrip::sysid
