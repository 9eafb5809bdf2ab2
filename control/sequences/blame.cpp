#include "control/sequences/blame.h"

#include <string>

#include "base/numbers.h"

namespace softgrip::control {

namespace {

using document::Problem;
using document::Problems;

std::vector<Parameter> at_defaults(std::vector<Parameter> parameters) {
  for (Parameter& parameter : parameters) parameter.value = parameter.default_value;
  return parameters;
}

std::string assignment(const Parameter& parameter) {
  return "`" + parameter.name + "` = " + written(parameter.value);
}

std::string which_end(const Parameter& parameter) {
  if (parameter.value == parameter.lower) return ", the lower end of its range,";
  if (parameter.value == parameter.upper) return ", the upper end of its range,";
  return "";
}

void tell_at_parameter(const document::Document& document, const Parameter& parameter, const Problems& found,
                       Problems& problems) {
  for (const Problem& problem : found.list()) {
    const std::string line = std::to_string(problem.at.line);
    problems.add(document.problem(parameter.at,
                                  "with " + assignment(parameter) + which_end(parameter) + " line " + line +
                                      " is wrong: " + problem.message,
                                  problem.hint));
  }
}

}  // namespace

void blame_values(const document::Document& document, const std::vector<Parameter>& parameters,
                  const Judge& judge, Problems& problems) {
  const Problems found = judge(parameters);
  if (found.empty()) return;
  const std::vector<Parameter> defaults = at_defaults(parameters);
  bool told = false;
  std::string together;
  if (judge(defaults).empty()) {
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      if (parameters[i].value == defaults[i].value) continue;
      std::vector<Parameter> alone = defaults;
      alone[i].value = parameters[i].value;
      const Problems of_it = judge(alone);
      tell_at_parameter(document, alone[i], of_it, problems);
      told = told || !of_it.empty();
      together += (together.empty() ? "with " : ", ") + assignment(parameters[i]);
    }
  }
  if (told) return;
  for (Problem problem : found.list()) {
    if (!together.empty()) problem.message = together + ": " + problem.message;
    problems.add(std::move(problem));
  }
}

void blame_ends(const document::Document& document, std::vector<Parameter> parameters, const Judge& judge,
                Problems& problems) {
  parameters = at_defaults(std::move(parameters));
  if (parameters.empty() || !judge(parameters).empty()) return;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    for (const double end : {parameters[i].lower, parameters[i].upper}) {
      if (end == parameters[i].default_value) continue;
      std::vector<Parameter> alone = parameters;
      alone[i].value = end;
      tell_at_parameter(document, alone[i], judge(alone), problems);
    }
  }
}

}  // namespace softgrip::control
