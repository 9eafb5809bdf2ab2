#pragma once
// Searching for causes: every candidate fitted together with the base, from several starts.

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/search/fit.h"

namespace softgrip::sysid {

/// A campaign as the search sees it.
struct SearchData {
  std::vector<Record> records;
  std::vector<Record> thinned;   ///< until a candidate is finished
  std::vector<Record> glimpsed;  ///< further, for a first look
  Scales scales;
  unsigned threads = 0;  ///< 0: as many as there are cores
  FitPoint given;        ///< the model as it was given: a second place to start from
};

/// Prepares records for the search: thinned copies, scales.
[[nodiscard]] SearchData make_search_data(std::vector<Record> records, const model::Model& given);

/// One candidate, fitted. `why_not` says why there is no fit.
struct Candidate {
  Cause cause;
  std::optional<StructureFit> fit;
  std::string why_not;
};

struct CandidateSearch {
  std::vector<Cause> only = {};  ///< empty: all
  /// Asked with the mean square that the best one leaves: whether the others are not worth following.
  std::function<bool(double best_mm2)> is_hopeless = {};
  std::function<void(std::size_t tried, std::size_t of)> progress = {};  ///< from any thread
};

/// Fits `current` plus each cause that it does not have yet. In the order of all_causes().
[[nodiscard]] std::vector<Candidate> fit_candidates(const SearchData& data, const StructureFit& current,
                                                    const CandidateSearch& search = {});

}  // namespace softgrip::sysid
