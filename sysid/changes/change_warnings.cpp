#include "sysid/changes/change_warnings.h"

#include <cmath>

#include "base/numbers.h"
#include "base/text.h"

namespace softgrip::sysid {

std::string closed_loops(const std::vector<std::string>& logs) {
  return "The command depends on the readings (closed loop) in " + with_commas(logs) +
         ". A fit to such logs can describe the controller instead of the finger, so a change may be missed. "
         "Record healthy and later logs with a planned command";
}

std::string other_start(const std::string& record) {
  return "No healthy log begins in the same state (pressurised or vented) as " + record +
         ", so a slow change after the start of this log is not evaluated. Record a healthy log that begins "
         "in this state";
}

std::string unfamiliar_input(double factor) {
  return "The input of the later logs is unlike the inputs of the healthy logs. Either the motion is larger, "
         "which increases the error of a model, or models that predict the healthy logs within their spread "
         "disagree about the later logs. The permitted error and the tolerances are therefore larger by a "
         "factor of up to " +
         significant(factor, 2) + " (mean square). Record a healthy log with such an input";
}

std::string unfamiliar_commands(double share) {
  return significant(100 * share, 2) +
         " % of the measured pressures of the later logs are not evaluated, because there the command is "
         "much farther from the pressure than in any healthy log. Record a healthy log with such steps";
}

std::string unusual_log(const std::string& record) {
  return "The error in " + record +
         " is larger than expected for a further healthy run, but the error in the other later logs is not. "
         "A change appears in every later log, so this difference is not reported as a change. Record " +
         record + " again";
}

std::string unusual_gain(double percent, bool is_limited) {
  return "The gain in the later logs is " + std::string(is_limited ? "at least " : "") +
         significant(std::abs(percent), 3) + " % " + (percent < 0 ? "lower" : "higher") +
         " than the gain in the healthy logs. The predictions of the healthy logs are so inaccurate that "
         "this difference is not significant. Record more healthy logs";
}

std::string unusual_zero(double zero_mm, double spread_mm, std::string_view unit) {
  return "The zero in the later logs is " + significant(std::abs(zero_mm), 3) + " " + std::string(unit) +
         (zero_mm < 0 ? " lower" : " higher") + " than in the healthy logs, where it varies by " +
         significant(spread_mm, 2) + " " + std::string(unit) +
         " (standard deviation). A different zero alone is not reported as a change, because a moved sensor "
         "and a constant load have this effect. Check the sensor and the load";
}

}  // namespace softgrip::sysid
