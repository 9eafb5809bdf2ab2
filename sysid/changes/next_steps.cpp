#include "sysid/changes/next_steps.h"

#include "sysid/changes/causes_without_block.h"
#include "sysid/diagnosis/causes/cause.h"

namespace softgrip::sysid {
namespace {

WhenChanged when_changed(std::string_view cause_id) {
  for (const CauseWithoutBlock& cause : causes_without_block) {
    if (cause.id == cause_id) return cause.when_changed;
  }
  const std::optional<Cause> cause = find_cause(cause_id);
  return cause ? cause->when_changed : WhenChanged{};
}

}  // namespace

std::vector<std::string_view> changes() {
  std::vector<std::string_view> ids;
  ids.reserve(causes_without_block.size() + all_causes().size());
  for (const CauseWithoutBlock& cause : causes_without_block) ids.push_back(cause.id);
  for (const Cause& cause : all_causes()) {
    if (!cause.when_changed.words.empty()) ids.push_back(cause.id);
  }
  return ids;
}

HealthSigns signs_of(std::string_view cause_id) {
  return when_changed(cause_id).signs;
}

SizedBy sized_by(std::string_view cause_id) {
  return when_changed(cause_id).size;
}

std::array<std::string_view, 2> next_steps(std::string_view cause_id) {
  return when_changed(cause_id).next_steps;
}

std::string_view plain_words(std::string_view cause_id) {
  return when_changed(cause_id).words;
}

}  // namespace softgrip::sysid
