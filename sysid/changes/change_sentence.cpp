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
    return "Unchanged: the later logs differ from the healthy ones by no more than those differ among "
           "themselves.";
  if (diagnosis.verdict == ChangeVerdict::unexplained)
    return "Something changed since the healthy logs, and no cause in the library explains it.";
  std::string text = "Since the healthy logs ";
  for (std::size_t i = 0; i < diagnosis.causes.size(); ++i)
    text += (i == 0 ? "" : "; and ") + named(diagnosis.causes[i]);
  if (diagnosis.verdict == ChangeVerdict::partly_explained) text += "; that is not all that changed";
  return text + ".";
}

}  // namespace softgrip::sysid
