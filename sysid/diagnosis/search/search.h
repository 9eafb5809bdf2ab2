#pragma once
// Searches for causes. Every candidate is fitted together with the base structure from several start points.
// Fits causes that can absorb part of the effect of a selected cause (Cause::confounded_with), and tests
// whether the data require each of these causes.

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/search/fit.h"
#include "sysid/diagnosis/search/holdout.h"

namespace softgrip::sysid {

/// The records of a campaign, complete and thinned, and their scales.
struct SearchData {
  std::vector<Record> records;
  std::vector<Record> thinned;  ///< thinned records for all fits of a candidate except the final fit
  /// Records with fewer samples than `thinned`, from which causes are preselected.
  std::vector<Record> glimpsed;
  Scales scales;
  unsigned threads = 0;  ///< number of threads; 0: one per core
  FitPoint given;        ///< given model, at which the search starts in addition to the refitted model
};

/// Prepares the records of a campaign for the search: computes thinned copies and the scales.
[[nodiscard]] SearchData make_search_data(std::vector<Record> records, const model::Model& given);

/// A cause and its fit. If the fit is missing, `why_not` states the reason.
struct Candidate {
  Cause cause;
  std::optional<StructureFit> fit;
  std::string why_not;
};

struct CandidateSearch {
  std::vector<Cause> only = {};  ///< causes that are tested; empty: all causes
  /// Called with the smallest mean square of all candidates. Returns true if the other candidates need no
  /// full fit.
  std::function<bool(double best_mm2)> is_hopeless = {};
  /// Called from any thread with the number of tested causes.
  std::function<void(std::size_t tried, std::size_t of)> progress = {};
};

/// Fits the structure `current` with each cause that it does not contain, in the order of all_causes().
[[nodiscard]] std::vector<Candidate> fit_candidates(const SearchData& data, const StructureFit& current,
                                                    const CandidateSearch& search = {});

/// A structure to which one cause was added. The added cause is confounded with another cause of the
/// structure.
struct Confounded {
  Cause cause;
  StructureFit fit;
  BlockLosses losses;  ///< losses on held-out blocks
};

/// Adds each cause that is confounded with a cause of the structure, one at a time, and fits the resulting
/// structure. Each fit changes all parameters together. Causes that are already part of the structure are not
/// added.
[[nodiscard]] std::vector<Confounded> fit_confounded(const SearchData& data, const StructureFit& structure,
                                                     const Division& division);

}  // namespace softgrip::sysid
