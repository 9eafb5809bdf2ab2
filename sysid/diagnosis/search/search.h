#pragma once
// Searches for causes. Every candidate is fitted together with the base structure, from several start points.

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/search/fit.h"

namespace softgrip::sysid {

/// The records of a campaign, prepared for the search.
struct SearchData {
  std::vector<Record> records;
  std::vector<Record> thinned;   ///< records for all fits of a candidate except the final one
  std::vector<Record> glimpsed;  ///< records with fewer samples than `thinned`, for the preselection
  Scales scales;
  unsigned threads = 0;  ///< 0: one per core
  FitPoint given;        ///< the given model, which is a second start point
};

/// Prepares records for the search: computes thinned copies and scales.
[[nodiscard]] SearchData make_search_data(std::vector<Record> records, const model::Model& given);

/// A fitted candidate. If there is no fit, `why_not` states the reason.
struct Candidate {
  Cause cause;
  std::optional<StructureFit> fit;
  std::string why_not;
};

struct CandidateSearch {
  std::vector<Cause> only = {};  ///< causes to be tested; empty: all
  /// Called with the smallest mean square of all candidates. Returns true if the other candidates need no
  /// full fit.
  std::function<bool(double best_mm2)> is_hopeless = {};
  std::function<void(std::size_t tried, std::size_t of)> progress = {};  ///< called from any thread
};

/// Fits `current` together with each cause that it does not contain, in the order of all_causes().
[[nodiscard]] std::vector<Candidate> fit_candidates(const SearchData& data, const StructureFit& current,
                                                    const CandidateSearch& search = {});

}  // namespace softgrip::sysid
