#include "control/elements/grip_result.h"

#include <array>
#include <cstddef>

#include "base/enum_table.h"

namespace softgrip::control {
namespace {
struct ResultNames {
  std::string_view title;
  std::string_view name;
};
constexpr auto results = enum_table<GripResult, ResultNames>({
    {GripResult::none, {"-", "none"}},
    {GripResult::holding, {"HOLDING", "holding"}},
    {GripResult::no_part, {"NO PART", "no_part"}},
    {GripResult::part_lost, {"PART LOST", "part_lost"}},
    {GripResult::released, {"RELEASED", "released"}},
    {GripResult::error, {"ERROR", "error"}},
});
constexpr auto evidences = enum_names<GripEvidence>({{GripEvidence::none, "none"},
                                                     {GripEvidence::displacement, "displacement"},
                                                     {GripEvidence::pressure, "pressure (weaker)"}});
}  // namespace

std::string_view title_of(GripResult result) noexcept {
  return results[result].title;
}
std::string_view name_of(GripResult result) noexcept {
  return results[result].name;
}
std::string_view name_of(GripEvidence evidence) noexcept {
  return evidences[evidence];
}

GripResult overall_result(std::span<const GripResult> results, std::uint32_t members) noexcept {
  std::array<std::size_t, control::results.size()> counts{};
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
