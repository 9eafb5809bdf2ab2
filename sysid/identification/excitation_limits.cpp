#include "sysid/identification/excitation_limits.h"

#include <algorithm>
#include <span>
#include <string_view>

#include "sysid/logs/excitation.h"

namespace softgrip::sysid {
namespace {

/// Returns prefixes of parameter names. A fit can determine the parameters with these prefixes only if the
/// logs contain the motion `excitation`.
std::span<const std::string_view> that_need(Excitation excitation) {
  static constexpr std::string_view hysteresis[]{
      "bouc_wen.beta",       "bouc_wen.gamma",    "bouc_wen.eta",        "asymmetric_bouc_wen.",
      "prandtl_ishlinskii.", "duhem_hysteresis.", "crescent_hysteresis."};
  static constexpr std::string_view creep[]{"kelvin_voigt.k", "kelvin_voigt.c", "slow_creep.",
                                            "pressure_dependent_creep."};
  static constexpr std::string_view shape[]{"bouc_wen.gamma",       "bouc_wen.eta",
                                            "asymmetric_bouc_wen.", "prandtl_ishlinskii.",
                                            "duhem_hysteresis.",    "crescent_hysteresis."};
  switch (excitation) {
    case Excitation::unloading:
      return hysteresis;
    case Excitation::rest:
      return creep;
    case Excitation::amplitudes:
      return shape;
  }
  return {};
}

}  // namespace

std::vector<std::string> excitation_limits(const std::vector<Log>& logs,
                                           const std::vector<Estimate>& parameters) {
  std::vector<std::string> sentences;
  for (const Excitation missing : missing_excitation(logs)) {
    std::string names;
    for (const Estimate& estimate : parameters) {
      const auto begins = [&](std::string_view name) { return estimate.name.starts_with(name); };
      if (estimate.free && std::ranges::any_of(that_need(missing), begins))
        names += (names.empty() ? "" : ", ") + estimate.name;
    }
    sentences.push_back(
        without(missing) +
        (names.empty() ? "" : "; the following parameters require the missing excitation: " + names));
  }
  return sentences;
}

}  // namespace softgrip::sysid
