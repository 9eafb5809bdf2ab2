#pragma once
// Searches for causes: every candidate is fitted together with the base, from several starts.

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/search/fit.h"

namespace softgrip::sysid {

/// The data of a campaign for the search.
struct SearchData {
  std::vector<Record> records;
  std::vector<Record> thinned;   ///< used until the final fit of a candidate
  std::vector<Record> glimpsed;  ///< thinned further, for the preselection
  Scales scales;
  unsigned threads = 0;  ///< 0: one per core
  FitPoint given;        ///< the given model, a second start point
};

/// Prepares records for the search: thinned copies, scales.
[[nodiscard]] SearchData make_search_data(std::vector<Record> records, const model::Model& given);

/// One fitted candidate. `why_not` is the reason if there is no fit.
struct Candidate {
  Cause cause;
  std::optional<StructureFit> fit;
  std::string why_not;
};

struct CandidateSearch {
  std::vector<Cause> only = {};  ///< empty: all
  /// Called with the smallest mean square of all candidates. Returns true if the others need no full fit.
  std::function<bool(double best_mm2)> is_hopeless = {};
  std::function<void(std::size_t tried, std::size_t of)> progress = {};  ///< called from any thread
};

/// Fits `current` plus each cause that it does not have, in the order of all_causes().
[[nodiscard]] std::vector<Candidate> fit_candidates(const SearchData& data, const StructureFit& current,
                                                    const CandidateSearch& search = {});

}  // namespace softgrip::sysid
