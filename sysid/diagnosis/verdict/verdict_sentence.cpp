#include <string>
#include <string_view>
#include <vector>

#include "base/enum_table.h"
#include "base/numbers.h"
#include "base/text.h"
#include "model/catalogue.h"
#include "sysid/diagnosis/residual/resolution.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/diagnosis/verdict/named_cause.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// Returns a value with the unit of the readings as text, for example "0.31 mm".
std::string reading(const Diagnosis& d, double value) {
  return significant(value, 2) + " " + std::string(model::name_of(d.extended_model.output_unit));
}

std::string listed(const std::vector<NamedCause>& causes) {
  return enumerated(causes, " and ", [&causes](const NamedCause& named) {
    std::string text = title_within(named.cause);
    for (const Cause& alternative : named.alternatives)
      text += " or " + alternative_title(alternative, causes);
    return text;
  });
}

/// Returns the verdict for the case that the model is correct but readings are wrong.
std::string readings_sentence(const Diagnosis& d) {
  std::string wrong;
  if (d.outliers.present)
    wrong = "The readings contain isolated wrong samples (" + significant(100 * d.outliers.share, 2) +
            " %, about " + reading(d, d.outliers.size_mm) + " off)";
  const bool repeats = d.sampling.interval_s > 0 || d.sampling.frozen_s > 0;
  if (repeats) {
    if (!wrong.empty())
      wrong += ", and some readings repeat";
    else
      wrong = "Readings repeat";
    std::vector<std::string> forms;
    if (d.sampling.interval_s > 0)
      forms.push_back("a new reading arrives every " + significant(d.sampling.interval_s, 2) + " s");
    if (d.sampling.frozen_s > 0)
      forms.push_back("the sensor is frozen for " + significant(d.sampling.frozen_s, 2) + " s");
    wrong += " (" + enumerated(forms, ", and ") + ")";
  }
  if (d.sampling.present && d.sampling.step_mm > 0)
    wrong += (wrong.empty() ? "" : ". ") + std::string("The sensor has a coarse resolution of ") +
             reading(d, d.sampling.step_mm) + ", which causes an error of " +
             reading(d, std::sqrt(rounding_variance_mm2(d.sampling.step_mm)));
  if (d.lead)
    wrong += (wrong.empty() ? "" : ". ") + std::string("The readings are ") + significant(d.lead->lead_s, 3) +
             " s ahead of their command, because the clocks of readings and commands differ";
  const std::string those = d.outliers.present || repeats ? "without these readings "
                            : d.lead                      ? "without this clock offset "
                                                          : "";
  return wrong + "; " + those + "the recalibrated model's error is " + reading(d, d.extended_rmse_mm) + ".";
}

/// Returns the verdict for the case that the readings are wrong and that the cause of a further error was
/// found by chance.
std::string readings_and_chance_sentence(const Diagnosis& d) {
  return readings_sentence(d) +
         " The cause of the remaining error cannot be named: in simulated data without any cause, the search "
         "reaches the error reduction by " +
         listed(d.partial) + ", too (p = " + significant(d.null_calibration->p_value, 2) + ").";
}

/// Returns the verdict for a valve with stick-slip. It states that the command alone does not determine the
/// position of a sticking valve, but the readings do.
std::string stick_slip_sentence(const Diagnosis& d, const std::string& before, const std::string& after) {
  return "The model lacks " + listed(d.causes) +
         ", because the valve sticks and jumps. The command alone does not determine the times of the jumps, "
         "so the "
         "held-out error only falls from " +
         before + " to " + after + ". With the jump times from the readings, the held-out error falls to " +
         reading(d, d.stick_slip->heldout_rmse_mm) + ".";
}

/// Returns the verdict for a valve that sticks in a closed loop. No held-out error of a simulation belongs to
/// the valve. The sentence states if the extended model, which the error of a simulation describes, contains
/// the valve.
std::string loop_sentence(const Diagnosis& d, const std::string& before, const std::string& after) {
  const std::string model = is_extended(d) ? "extended model" : "recalibrated model";
  const bool contained = position_of(d.extended_model, d.causes.front().cause).has_value();
  return "The model lacks " + listed(d.causes) +
         ": one-step predictions in the closed loop show that the valve sticks, with a dead band of about " +
         with_commas(*d.loop_bands_kpa, [](double kpa) { return significant(kpa, 2); }) + " kPa. The " +
         model + (contained ? " contains a dead band" : " does not contain this dead band") +
         "; its held-out error is " + after +
         (is_extended(d) ? ", and the held-out error of the recalibrated model is " + before
                         : std::string()) +
         ".";
}

/// Returns the text that follows the named causes: ": with them the held-out error falls from 2 mm to 1 mm".
/// If the error does not fall, the text states that the model without the causes needs an inverse response.
std::string with_them(const Diagnosis& d, const std::string& before, const std::string& after) {
  const std::string them = d.causes.size() > 1 ? "them" : "it";
  if (d.extended_rmse_mm < (1 - limits::negligible_share) * d.recalibrated_rmse_mm)
    return ": with " + them + " the held-out error falls from " + before + " to " + after;
  return ": without " + them +
         " the model fits these logs only with an inverse response, which no finger has; the held-out error "
         "is " +
         before + " without and " + after + " with " + them;
}

std::string unexplained_sentence(const Diagnosis& d, const std::string& before, const std::string& after) {
  if (d.partial.empty()) return "The model has an error that no known cause explains.";
  if (d.null_calibration && d.null_calibration->reach_the_gain()) {
    return "The model has an error whose cause cannot be named: " + listed(d.partial) +
           " would lower the held-out error from " + before + " to " + after +
           ", but in simulated data without any cause the search reaches this reduction, too (p = " +
           significant(d.null_calibration->p_value, 2) + ").";
  }
  return "The model has an error that no known cause explains completely: with " + listed(d.partial) +
         " the held-out error falls from " + before + " to " + after + ", and " +
         reading(d, d.unexplained_error.excess_mm) + " remains unexplained, " +
         significant(d.unexplained_error.excess_mm / d.noise_mm, 2) + " times the noise.";
}

bool valve_lacks(const Diagnosis& d) {
  return d.in_valve && !d.in_valve->named.empty();
}

/// Returns the sentence about the valve, for example " Between the command and the measured pressure, the
/// model lacks valve dead band (band_kpa 1.34)."
std::string sentence_of_valve(const Diagnosis& d) {
  std::string numbers;
  for (const NamedCause& named : d.in_valve->named) {
    for (const CauseParameter& p : named.parameters)
      numbers += (numbers.empty() ? "" : ", ") + p.name + " " + significant(p.value, 3);
  }
  return " Between the command and the measured pressure, the model lacks " + listed(d.in_valve->named) +
         " (" + numbers + ").";
}

std::string sentence_of_logs(const Diagnosis& d) {
  const std::string before = reading(d, d.recalibrated_rmse_mm);
  const std::string after = reading(d, d.extended_rmse_mm);
  switch (d.verdict) {
    case Verdict::adequate:
      return "The model explains " +
             (valve_lacks(d) ? model::in_unit("the displacement", d.extended_model.output_unit)
                             : "these logs") +
             " down to the noise (" + reading(d, d.noise_mm) + ")" +
             (valve_lacks(d) ? "." : ", so no change of the model is necessary.");
    case Verdict::recalibrate:
      return "The structure of the model is right, but its parameters are wrong. By recalibration, the error "
             "falls from " +
             significant(d.as_given_rmse_mm, 2) + " to " + before + ".";
    case Verdict::cause_found:
      if (!is_extended(d)) return readings_sentence(d);
      if (d.stick_slip) return stick_slip_sentence(d, before, after);
      return "The model lacks " + listed(d.causes) + with_them(d, before, after) + ".";
    case Verdict::ambiguous:
      return "The model lacks one of several causes that these logs cannot separate (" + listed(d.causes) +
             ")" + with_them(d, before, after) + ".";
    case Verdict::partly_explained:
      if (d.loop_bands_kpa) return loop_sentence(d, before, after);
      if (!is_extended(d) && d.null_calibration && d.null_calibration->reach_the_gain())
        return readings_and_chance_sentence(d);
      return "The model lacks " + listed(d.causes) + with_them(d, before, after) + "; " +
             reading(d, d.unexplained_error.excess_mm) + " remains unexplained, " +
             significant(d.unexplained_error.excess_mm / d.noise_mm, 2) + " times the noise.";
    case Verdict::unexplained:
      return unexplained_sentence(d, before, after);
  }
  return {};
}

}  // namespace

std::string_view name_of(Verdict verdict) {
  static constexpr auto names = enum_names<Verdict>({
      {Verdict::adequate, "adequate"},
      {Verdict::recalibrate, "recalibrate"},
      {Verdict::cause_found, "cause_found"},
      {Verdict::ambiguous, "ambiguous"},
      {Verdict::partly_explained, "partly_explained"},
      {Verdict::unexplained, "unexplained"},
  });
  return names[verdict];
}

Verdict whole_verdict(const Diagnosis& d) {
  if (!d.in_valve || d.in_valve->named.empty()) return d.verdict;
  if (d.verdict == Verdict::unexplained) return Verdict::partly_explained;
  if (d.verdict == Verdict::partly_explained) return d.verdict;
  return d.verdict == Verdict::ambiguous || any_alternatives(d.in_valve->named) ? Verdict::ambiguous
                                                                                : Verdict::cause_found;
}

std::string verdict_sentence(const Diagnosis& d) {
  return sentence_of_logs(d) + (valve_lacks(d) ? sentence_of_valve(d) : std::string()) +
         (d.gauge ? " " + d.gauge->sentence : std::string());
}

}  // namespace softgrip::sysid
