
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <softgrip/softgrip.h>

#include "python/core/interruptible.h"
#include "python/core/values.h"

namespace py = pybind11;

namespace softgrip::python {
namespace {

template <class Value>
py::object optional_of(const std::optional<Value>& value) {
  return value ? py::cast(*value) : py::none();
}

/// Returns the keyword arguments of the Python class softgrip.FingerHealth.
py::dict dict_of_finger(FingerHealth finger) {
  py::list indicators, alarms, suspects;
  for (HealthIndicator& one : finger.indicators) {
    py::dict dict;
    dict["id"] = one.id;
    dict["title"] = one.title;
    dict["unit"] = one.unit;
    dict["value"] = optional_of(one.value);
    dict["reference"] = optional_of(one.reference);
    dict["spread"] = optional_of(one.spread);
    dict["values"] = array_of(std::move(one.values));
    indicators.append(dict);
  }
  for (const HealthAlarm& one : finger.alarms) {
    py::dict dict;
    dict["indicator"] = one.indicator;
    dict["change"] = one.change;
    dict["since"] = one.since;
    dict["noticed"] = one.noticed;
    dict["grips_until_noticed"] = one.grips_until_noticed;
    dict["active"] = one.active;
    alarms.append(dict);
  }
  for (const Suspect& one : finger.suspects) {
    py::dict dict;
    dict["id"] = one.id;
    dict["words"] = one.words;
    dict["next_steps"] = py::tuple(py::cast(one.next_steps));
    suspects.append(dict);
  }
  py::dict dict;
  dict["finger"] = finger.finger;
  dict["state"] = finger.state;
  dict["sentence"] = finger.sentence;
  dict["unit"] = name_of(finger.unit);
  dict["grips"] = finger.grips;
  dict["points"] = py::tuple(py::cast(finger.points));
  dict["indicators"] = indicators;
  dict["alarms"] = alarms;
  dict["suspects"] = suspects;
  dict["advice"] = py::tuple(py::cast(finger.advice));
  dict["html"] = finger.html;
  return dict;
}

py::dict judged(const std::vector<std::string>& recordings, const std::string& baseline,
                const std::string& points, double false_alarm_points, const std::string& notes,
                const std::string& scores, const py::object& progress) {
  HealthOptions options;
  options.points =
      chosen<HealthPoints>("points", points, {{"day", HealthPoints::day}, {"run", HealthPoints::run}});
  options.false_alarm_points = false_alarm_points;
  options.notes = notes;
  options.scores = scores;
  Health found = interruptible(progress, options, [&] { return health(recordings, baseline, options); });
  py::list fingers, skipped;
  for (FingerHealth& finger : found.fingers) fingers.append(dict_of_finger(std::move(finger)));
  for (const SkippedRecording& one : found.skipped) skipped.append(py::make_tuple(one.recording, one.reason));
  py::dict dict;
  dict["alarm"] = found.alarm;
  dict["fingers"] = fingers;
  dict["warnings"] = found.warnings;
  dict["skipped"] = skipped;
  dict["json"] = found.json;
  return dict;
}

}  // namespace

void add_health(py::module_& module) {
  module.def("health", judged);
}

}  // namespace softgrip::python
