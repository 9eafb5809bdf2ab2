#include "control/elements/grip_result.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace softgrip::control {
namespace {
struct ResultNames {
  std::string_view title;
  std::string_view name;
};
constexpr std::array<ResultNames, 6> results{{
    {"-", "none"},
    {"HOLDING", "holding"},
    {"NO PART", "no_part"},
    {"PART LOST", "part_lost"},
    {"RELEASED", "released"},
    {"ERROR", "error"},
}};
constexpr std::array<std::string_view, 3> evidences{"none", "displacement", "pressure (weaker)"};
}  // namespace

std::string_view title_of(GripResult result) noexcept {
  return results[static_cast<std::size_t>(result)].title;
}
std::string_view name_of(GripResult result) noexcept {
  return results[static_cast<std::size_t>(result)].name;
}
std::string_view name_of(GripEvidence evidence) noexcept {
  return evidences[static_cast<std::size_t>(evidence)];
}

GripResult overall_result(std::span<const GripResult> results, std::uint32_t members) noexcept {
  std::array<std::size_t, static_cast<std::size_t>(GripResult::error) + 1> counts{};
  std::size_t fingers = 0;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if ((members >> i & 1U) == 0) continue;
    ++counts[static_cast<std::size_t>(results[i])];
    ++fingers;
  }
  const auto count = [&](GripResult result) { return counts[static_cast<std::size_t>(result)]; };
  for (const GripResult worst : {GripResult::error, GripResult::part_lost, GripResult::no_part}) {
    if (count(worst) > 0) return worst;
  }
  for (const GripResult common : {GripResult::holding, GripResult::released}) {
    if (fingers > 0 && count(common) == fingers) return common;
  }
  return GripResult::none;
}

}  // namespace softgrip::control
