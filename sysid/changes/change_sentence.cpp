#include <string>

#include "base/numbers.h"
#include "sysid/changes/change.h"
#include "sysid/changes/next_steps.h"

namespace softgrip::sysid {
namespace {

std::string named(const ChangeCause& cause) {
  std::string text = std::string(plain_words(cause.id)) + " (" + cause.id + ": " + size_text(cause) + ")";
  for (const std::string& alternative : cause.alternatives)
    text += ", or " + std::string(plain_words(alternative)) + " (" + alternative + ")";
  return text;
}

}  // namespace

std::string size_text(const ChangeCause& cause) {
  return cause.size.what + " " + significant(cause.size.value, 3) + " " +
         model::in_unit(cause.size.unit, cause.output_unit);
}

std::string interval_text(const ChangeCause& cause) {
  return cause.intervals.size ? text_of(*cause.intervals.size, cause.size.value, " .. ") : "-";
}

std::string change_sentence(const ChangeDiagnosis& diagnosis) {
  if (diagnosis.verdict == ChangeVerdict::unchanged)
    return "Unchanged: the later logs differ from the healthy logs by no more than the healthy logs differ "
           "from each other.";
  if (diagnosis.verdict == ChangeVerdict::unexplained)
    return "The finger has changed since the healthy logs, but no cause of the library explains the change.";
  std::string text = "Change since the healthy logs: ";
  for (std::size_t i = 0; i < diagnosis.causes.size(); ++i)
    text += (i == 0 ? "" : "; and ") + named(diagnosis.causes[i]);
  if (diagnosis.verdict == ChangeVerdict::partly_explained)
    text += "; another part of the change remains unexplained";
  return text + ".";
}

}  // namespace softgrip::sysid
