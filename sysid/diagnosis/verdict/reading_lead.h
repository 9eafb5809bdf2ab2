#pragma once
// Estimates the time by which the readings lead their command.

#include <optional>
#include <vector>

#include "sysid/diagnosis/search/selection.h"
#include "sysid/fitting/interval.h"

namespace softgrip::sysid {

struct ReadingLead {
  double lead_s = 0;
  /// 95 % interval from the profile of the mean square: all parameters of the structure are fitted at each
  /// lead.
  Interval ci95;
};

struct LeadFit {
  ReadingLead lead;
  StructureFit fit;
  std::vector<Record> records;  ///< records whose drive is shifted by the lead
};

/// Returns the records with a drive that comes `lead_s` earlier. The first sample keeps its drive, which is
/// the initial state of the record. Readings that would need a drive after the end of the record become NaN.
[[nodiscard]] std::vector<Record> with_drive_ahead(std::vector<Record> records, double lead_s);

/// Fits the lead exactly, if a selection contains clock_offset. That block extrapolates the motion and is
/// wrong at its corners; the shifted drive is not.
/// @returns no value if the selection does not contain the cause, if the readings do not lead with 95 %
/// confidence, or if the shift leaves more than the causes of the selection.
[[nodiscard]] std::optional<LeadFit> fit_lead(const SearchData& data, const Selection& selection,
                                              double noise_mm);

}  // namespace softgrip::sysid
