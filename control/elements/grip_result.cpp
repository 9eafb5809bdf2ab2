#include "control/elements/grip_result.h"

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

}  // namespace softgrip::control
