#include "control/sequences/parameters.h"

#include <algorithm>
#include <string>
#include <utility>

#include "base/numbers.h"
#include "base/text.h"
#include "control/sequences/sequence_keys.h"
#include "document/reader.h"

namespace softgrip::control {
namespace {

using document::Document;
using document::MapReader;
using document::Node;
using document::Problems;

constexpr std::size_t most_parameters = 16;
constexpr const char* unit_hint =
    "end the name with its unit (_kpa, _mm, _s, _hz, _kpa_per_s or _mm_per_s), or write `unit: none` for a "
    "number without unit";

const Node::Entry* entry_of(const Node& map, std::string_view key) {
  const auto found = std::find_if(map.entries.begin(), map.entries.end(),
                                  [key](const Node::Entry& entry) { return entry.key == key; });
  return found == map.entries.end() ? nullptr : &*found;
}

/// Returns a hint for the unknown name `name`: "did you mean `squeeze_kpa`?", or a list of the parameters if
/// no parameter has a similar name.
std::string hint_of(const std::string& name, const std::vector<Parameter>& parameters) {
  if (parameters.empty()) return "this sequence has no `parameters`";
  std::vector<std::string> names;
  names.reserve(parameters.size());
  for (const Parameter& parameter : parameters) names.push_back(parameter.name);
  const std::string near = document::nearest(name, names);
  if (!near.empty()) return "did you mean " + document::in_backticks(near) + "?";
  for (const Parameter& parameter : parameters) {
    if (parameter.name.starts_with(name + "_"))
      return "did you mean " + document::in_backticks(parameter.name) + "?";
  }
  return "there are " + with_commas(names, document::in_backticks);
}

bool is_name(std::string_view name) {
  const auto allowed = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  return !name.empty() && name.size() <= 40 && name[0] >= 'a' && name[0] <= 'z' &&
         std::all_of(name.begin(), name.end(), allowed);
}

/// Completes the unit of a parameter. The unit comes from the end of the parameter's name or from its key
/// `unit:`. If both give a unit, the two units must be equal.
void complete_unit(MapReader& map, Parameter& parameter) {
  const std::string_view own = document::unit_at_end(parameter.name);
  const bool known = std::find(parameter_units.begin(), parameter_units.end(), own) != parameter_units.end();
  if (!map.has("unit")) {
    if (known) parameter.unit = own;
    if (!known)
      map.report("unit", "the unit of " + document::in_backticks(parameter.name) + " is not stated",
                 unit_hint);
  } else if (known && parameter.unit != own) {
    map.report("unit", "the name " + document::in_backticks(parameter.name) +
                           " ends with a different unit, " + document::in_backticks(own));
  }
  if (parameter.unit == "none") parameter.unit.clear();
}

Parameter read_parameter(const Document& document, const Node::Entry& entry, Problems& problems) {
  Parameter parameter;
  parameter.name = entry.key;
  parameter.at = entry.key_at;
  if (!is_name(entry.key)) {
    problems.add(document.problem(entry.key_at,
                                  document::in_backticks(entry.key) + " is not a valid name of a parameter",
                                  "lower-case letters, digits and underscores, as in `squeeze_kpa`"));
  }
  MapReader map(document, entry.value, problems, "parameter " + document::in_backticks(entry.key));
  read_keys(map, sequence_keys().parameter, parameter);
  complete_unit(map, parameter);
  parameter.value = parameter.default_value;
  if (map.good("range") && parameter.lower >= parameter.upper) {
    map.report("range", "the first number of `range` must be below the second number");
  } else if (map.good("range") && map.good("default") &&
             (parameter.default_value < parameter.lower || parameter.default_value > parameter.upper)) {
    map.report("default", "`default` is " + written(parameter.default_value) + ", outside its range of " +
                              written(parameter.lower) + " to " + written(parameter.upper));
  }
  return parameter;
}

/// Replaces the names of parameters in the steps of a copy of a document by their values.
class Binder {
 public:
  Binder(const Document& document, const std::vector<Parameter>& parameters, Problems& problems)
      : document_(document), parameters_(parameters), problems_(problems), used_(parameters.size(), false) {}

  void bind(Node& node, std::string_view key) {
    for (Node& item : node.items) bind(item, {});
    for (Node::Entry& entry : node.entries) bind(entry.value, entry.key);
    if (node.kind == Node::Kind::scalar && !node.quoted && node.scalar.starts_with('$')) replace(node, key);
  }

  void report_unused() {
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      if (used_[i]) continue;
      problems_.add(document_.problem(
          parameters_[i].at, "no step uses the parameter " + document::in_backticks(parameters_[i].name),
          "write $" + parameters_[i].name + " as the value of a key in a step"));
    }
  }

 private:
  void replace(Node& node, std::string_view key) {
    const std::string name = node.scalar.substr(1);
    const auto found = std::find_if(parameters_.begin(), parameters_.end(),
                                    [&](const Parameter& parameter) { return parameter.name == name; });
    if (found == parameters_.end()) {
      refuse(node, "there is no parameter " + document::in_backticks(name),
             name.find_first_of(" +-*/()") == std::string::npos
                 ? hint_of(name, parameters_)
                 : "write the parameter alone as the value, because expressions are not supported");
      return;
    }
    used_[static_cast<std::size_t>(found - parameters_.begin())] = true;
    if (key.empty()) {
      refuse(node, "a parameter can replace the value of a key, but not an item of a list", "");
    } else if (const std::string_view unit = document::unit_at_end(key); unit != found->unit) {
      const auto in_words = [](std::string_view text) {
        return text.empty() ? "a plain number" : document::in_backticks(text);
      };
      refuse(node,
             document::in_backticks(key) + " is " + in_words(unit) + ", the parameter " +
                 document::in_backticks(name) + " is " + in_words(found->unit),
             "");
    } else {
      node.stands_for = std::exchange(node.scalar, written(found->value));
    }
  }

  void refuse(Node& node, std::string message, std::string hint) {
    problems_.add(document_.problem(node.at, std::move(message), std::move(hint)));
    node.refused = true;
  }

  const Document& document_;
  const std::vector<Parameter>& parameters_;
  Problems& problems_;
  std::vector<bool> used_;
};

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
  return ",";
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

std::vector<Parameter> read_parameters(const Document& document, Problems& problems) {
  std::vector<Parameter> parameters;
  const Node::Entry* const declared = entry_of(document.root, "parameters");
  if (declared == nullptr) return parameters;
  const Node& map = declared->value;
  if (map.kind != Node::Kind::map) {
    if (!map.refused) {
      problems.add(
          document.problem(map.at, "`parameters` must be a map of names",
                           "squeeze_kpa: {default: 5, range: [3, 10], about: pressure above contact}"));
    }
    return parameters;
  }
  if (map.entries.size() > most_parameters) {
    problems.add(
        document.problem(declared->key_at, "more than " + std::to_string(most_parameters) + " parameters"));
  }
  for (std::size_t i = 0; i < std::min(map.entries.size(), most_parameters); ++i) {
    parameters.push_back(read_parameter(document, map.entries[i], problems));
  }
  return parameters;
}

void set_values(std::span<const Argument> arguments, const Document& document,
                std::vector<Parameter>& parameters, Problems& problems) {
  std::vector<std::string> set;
  for (const Argument& argument : arguments) {
    const auto found = std::find_if(parameters.begin(), parameters.end(), [&](const Parameter& parameter) {
      return parameter.name == argument.name;
    });
    if (found == parameters.end()) {
      const Node::Entry* const declared = entry_of(document.root, "parameters");
      problems.add(document.problem(declared == nullptr ? document.root.at : declared->key_at,
                                    "the sequence has no parameter " + document::in_backticks(argument.name),
                                    hint_of(argument.name, parameters)));
    } else if (std::find(set.begin(), set.end(), argument.name) != set.end()) {
      problems.add(document.problem(
          found->at, "the parameter " + document::in_backticks(argument.name) + " is set twice"));
    } else if (!(argument.value >= found->lower && argument.value <= found->upper)) {
      problems.add(document.problem(
          found->at,
          document::in_backticks(argument.name) + " is set to " + written(argument.value) +
              ", outside its range of " + written(found->lower) + " to " + written(found->upper),
          document::hint_for_range(argument.name, argument.value, found->lower, found->upper)));
    } else {
      found->value = argument.value;
    }
    set.push_back(argument.name);
  }
}

Document with_values(const Document& document, const std::vector<Parameter>& parameters, Problems& problems) {
  Document bound = document;
  Binder binder(document, parameters, problems);
  for (Node::Entry& entry : bound.root.entries) {
    if (entry.key == "steps") binder.bind(entry.value, {});
  }
  // If a part of the document could not be read, a step in this part may use the parameter.
  if (document.complete) binder.report_unused();
  return bound;
}

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
