#pragma once
// Searches for causes. Every candidate is fitted together with the base structure, from several start points.
// Fits causes that can absorb part of the effect of a selected cause (Cause::confounded_with). Tests if the
// data require each of these causes in addition to the selected cause.

#include <cstddef>
#include <functional>
#include <vector>

#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/search/fit.h"
#include "sysid/diagnosis/search/holdout.h"

namespace softgrip::sysid {

/// The records of a measurement campaign, thinned copies of the records, and the scales of the campaign.
struct SearchData {
  std::vector<Record> records;
  std::vector<Record> thinned;  ///< thinned records; they are used for all fits of a candidate except the
                                ///< first and the final ones
  /// Records with half as many samples as `thinned`. They are used for the first, coarse fits of all
  /// candidates.
  std::vector<Record> glimpsed;
  Scales scales;
  unsigned threads = 0;  ///< number of threads; 0: one per core
  FitPoint given;        ///< given model; the search starts at this model in addition to the refitted model
};

/// Prepares a campaign for the search: computes the thinned copies of the records, and the scales.
[[nodiscard]] SearchData make_search_data(std::vector<Record> records, const model::Model& given);

/// A cause and its fit. If the cause was not fitted or was rejected, `why_not` states the reason.
struct Candidate {
  Cause cause;
  std::optional<StructureFit> fit;
  std::string why_not;
};

/// Number of candidates that always get a full fit to all samples. Their losses on held-out blocks are
/// computed too, which requires a refit for each fold.
inline constexpr std::size_t finished_candidates = 4;

struct CandidateSearch {
  std::vector<Cause> only = {};  ///< causes that may be tested; empty: all causes
  /// Function that receives the smallest mean square of all candidates. It returns true if the other
  /// candidates need no full fit.
  std::function<bool(double best_mm2)> is_hopeless = {};
  /// Function that receives the number of tested causes and the number of causes to test. Any thread may call
  /// it.
  std::function<void(std::size_t tried, std::size_t of)> progress = {};
};

/// Fits the structure `current` with one additional cause, for each cause that a fit can find
/// (Cause::found_by_fitting) and that `current` does not contain. The results have the order of search.only,
/// or of all_causes() if this list is empty.
[[nodiscard]] std::vector<Candidate> fit_candidates(const SearchData& data, const StructureFit& current,
                                                    const CandidateSearch& search = {});

/// A structure with one additional cause. This cause is confounded with another cause of the structure.
struct Confounded {
  Cause cause;
  StructureFit fit;
  BlockLosses losses;  ///< losses of the structure on held-out blocks
};

/// Adds each cause that is confounded with a cause of the structure, and fits the extended structure. One
/// cause is added at a time, and all parameters are fitted together. Causes that the structure already
/// contains are not added.
[[nodiscard]] std::vector<Confounded> fit_confounded(const SearchData& data, const StructureFit& structure,
                                                     const Division& division);

}  // namespace softgrip::sysid
