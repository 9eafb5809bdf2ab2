#include "sysid/diagnosis/search/confounded.h"

#include <algorithm>
#include <utility>

namespace softgrip::sysid {

std::vector<Confounded> fit_confounded(const SearchData& data, const StructureFit& structure,
                                       const Division& division) {
  std::vector<Cause> others;
  for (const Cause& cause : structure.causes) {
    for (const std::string_view id : cause.confounded_with) {
      const Cause other = *find_cause(id);
      if (std::find(others.begin(), others.end(), other) == others.end()) others.push_back(other);
    }
  }
  std::vector<Confounded> list;
  for (const Cause& other : others) {
    for (Candidate& found : fit_candidates(data, structure, {.only = {other}})) {
      if (!found.fit) continue;
      BlockLosses losses = held_out_losses(data.records, division, *found.fit);
      list.push_back({other, std::move(*found.fit), std::move(losses)});
    }
  }
  return list;
}

}  // namespace softgrip::sysid
