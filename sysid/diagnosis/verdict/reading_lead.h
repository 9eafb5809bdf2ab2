#pragma once
// Estimates the time by which the readings react before the command changes.

#include <optional>
#include <vector>

#include "sysid/diagnosis/search/selection.h"
#include "sysid/fitting/interval.h"

namespace softgrip::sysid {

struct ReadingLead {
  double lead_s = 0;
  /// 95 % interval of the lead. It follows from the mean square error as a function of the lead, with all
  /// parameters of the structure refitted for each lead.
  Interval ci95;
};

struct LeadFit {
  ReadingLead lead;
  StructureFit fit;
  std::vector<Record> records;  ///< records whose drive is shifted by the lead
};

/// Shifts the drive of the records to an earlier time by `lead_s` and returns the records. The first sample
/// keeps its drive, because this drive defines the initial state of the record. A reading becomes NaN if its
/// shifted drive would lie after the end of the record.
[[nodiscard]] std::vector<Record> with_drive_ahead(std::vector<Record> records, double lead_s);

/// Determines the lead precisely if a selection contains the cause clock_offset. The block of this cause
/// extrapolates the motion and is inaccurate at corners. A shifted drive has no such error.
/// @returns no value if the selection does not contain the cause, if zero lies within the 95 % interval of
/// the lead, or if the shifted drive leaves more error than the causes of the selection.
[[nodiscard]] std::optional<LeadFit> fit_lead(const SearchData& data, const Selection& selection,
                                              double noise_mm);

}  // namespace softgrip::sysid
