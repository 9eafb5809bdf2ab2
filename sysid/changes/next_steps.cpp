#include "sysid/changes/next_steps.h"

#include "sysid/diagnosis/causes/cause.h"

namespace softgrip::sysid {
namespace {

/// What is wrong with the air itself is no cause of a model.
constexpr WhenChanged blocked_line{
    "the line to the finger lets less air through",
    {"Blow the tube through, look for kinks and for water in it.",
     "Swap the tube for a new one of the same length and record the same log again."},
    {{{HealthNumber::lag, Moves::up}}}};
constexpr WhenChanged leak{
    "pressure is lost while it should hold",
    {"Hold full pressure and listen or spray soapy water along tube, fittings and finger.",
     "Close the tube at the valve, then at the finger, and see at which end the pressure still falls."},
    {{{HealthNumber::pressure_loss, Moves::up},
      {HealthNumber::leak, Moves::up},
      {HealthNumber::gain, Moves::down}}}};

WhenChanged when_changed(std::string_view cause_id) {
  if (cause_id == "blocked_line") return blocked_line;
  if (cause_id == "leak") return leak;
  const std::optional<Cause> cause = find_cause(cause_id);
  return cause ? cause->when_changed : WhenChanged{};
}

constexpr std::array<std::string_view, 2> causes_of_the_air{"leak", "blocked_line"};

}  // namespace

std::vector<std::string_view> changes() {
  std::vector<std::string_view> ids(causes_of_the_air.begin(), causes_of_the_air.end());
  for (const Cause& cause : all_causes()) {
    if (!cause.when_changed.words.empty()) ids.push_back(cause.id);
  }
  return ids;
}

HealthSigns signs_of(std::string_view cause_id) {
  return when_changed(cause_id).signs;
}

std::array<std::string_view, 2> next_steps(std::string_view cause_id) {
  return when_changed(cause_id).next_steps;
}

std::string_view plain_words(std::string_view cause_id) {
  return when_changed(cause_id).words;
}

}  // namespace softgrip::sysid
