#include "control/sequences/sequence_file.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text.h"
#include "control/sequences/parameters.h"
#include "control/sequences/sequence_keys.h"

namespace softgrip::control {

namespace {

using document::Document;
using document::MapReader;
using document::Node;
using document::Problems;

// Each function reads one part of a sequence file. After a problem, it reports the problem and continues with
// the next key.

constexpr std::size_t most_steps = 200;

std::vector<std::string> read_channel_names(MapReader& map) {
  std::vector<std::string> list;
  for (const Node* item : map.sequence("channels", false)) {
    if (item->kind != Node::Kind::scalar || item->scalar.empty()) {
      map.report(item->at, "expected the name of a channel");
    } else if (std::find(list.begin(), list.end(), item->scalar) != list.end()) {
      map.report(item->at, "channel '" + item->scalar + "' is listed twice");
    } else {
      list.push_back(item->scalar);
    }
  }
  if (list.empty() && map.has("channels"))
    map.report("channels", "name at least one channel", "to use all channels of the rig, omit the key");
  return list;
}

/// Reads the speed or the duration of a ramp.
void read_ramp(MapReader& map, Target& target) {
  read_keys(map, sequence_keys().ramp, target);
  const bool displacement = target.quantity == Target::Quantity::displacement_mm;
  const std::string own = displacement ? "speed_mm_per_s" : "speed_kpa_per_s";
  const std::string other = displacement ? "speed_kpa_per_s" : "speed_mm_per_s";
  if (map.has(other)) {
    map.report(other, "the speed and the target have different units", "write " + own);
  } else if (map.has(own) && map.has("duration_s")) {
    map.report("duration_s", "a ramp has a speed or a duration, not both");
  } else if (displacement && !map.has(own) && !map.has("duration_s")) {
    map.report("displacement_mm", "a target in displacement_mm requires speed_mm_per_s or duration_s");
  }
}

/// Reads the target of a step: displacement_mm or pressure_kpa, and the speed or duration.
void read_target(MapReader& map, Target& target) {
  const bool displacement = map.has("displacement_mm");
  target.quantity = displacement ? Target::Quantity::displacement_mm : Target::Quantity::pressure_kpa;
  if (!displacement || map.has("pressure_kpa")) read_keys(map, sequence_keys().target_kpa, target);
  read_keys(map, sequence_keys().target_mm, target);
  if (displacement && map.has("pressure_kpa"))
    map.report("pressure_kpa", "a step has a target in displacement_mm or in pressure_kpa, not in both");
  read_ramp(map, target);
}

/// Reads the action on contact. If a contact makes the step fail, the file must also give on_fail. If the
/// move has a tolerance, read_move() has already read on_fail.
void read_on_contact(MapReader& map, Step& step, OnContact otherwise) {
  step.on_contact = otherwise;
  step.on_contact_stated = map.has("on_contact");
  read_keys(map, sequence_keys().on_contact, step);
  if (step.on_contact == OnContact::fail && !step.tolerance_mm)
    read_keys(map, sequence_keys().failing_contact, step);
}

/// Reads a move. A move with a tolerance can fail. Therefore, the file must give on_fail for such a move.
void read_move(MapReader& map, Step& step) {
  read_target(map, step.target);
  read_keys(map, sequence_keys().move, step);
  if (step.tolerance_mm) {
    if (step.target.quantity != Target::Quantity::displacement_mm)
      map.report("tolerance_mm", "tolerance_mm requires a target in displacement_mm");
    read_keys(map, sequence_keys().tolerance, step);
  }
  read_keys(map, sequence_keys().bounds, step.bounds);
  read_on_contact(map, step, step.tolerance_mm ? OnContact::fail : OnContact::hold);
}

/// Checks that a verification by position has two displacements, and that a verification by pressure has one
/// bound. A grip above the rest pressure needs a lower bound of the pressure, and a grip below the rest
/// pressure needs an upper bound.
void read_evidence(MapReader& map, Verify& verify) {
  if (verify.by == VerifyBy::pressure) {
    read_keys(map, sequence_keys().verify_pressure, verify);
    const bool below = map.has("pressure_max_kpa");
    if (below && map.has("pressure_min_kpa"))
      map.report("pressure_max_kpa", "give either pressure_min_kpa or pressure_max_kpa, not both");
    if (below) verify.pressure_min_kpa = -infinite;
    (void)map.child("pressure_min_kpa", !below);
    return;
  }
  read_keys(map, sequence_keys().verify_position, verify);
  const bool both = map.has("displacement_min_mm") && map.has("displacement_max_mm");
  if (verify.by == VerifyBy::position && !both)
    map.report("by", "verification by position needs displacement_min_mm and displacement_max_mm");
  if (both && verify.displacement_min_mm >= verify.displacement_max_mm)
    map.report("displacement_max_mm", "displacement_max_mm must be above displacement_min_mm");
}

/// Reads the gripping pressure of a step. If the step has no squeeze_max_kpa, the final gripping pressure
/// squeeze_kpa is also the upper limit.
void read_squeeze(MapReader& map, Step& step) {
  read_keys(map, sequence_keys().squeeze, step.squeeze);
  const bool given = map.has("squeeze_kpa");
  if (!given && map.has("squeeze_speed_kpa_per_s"))
    map.report("squeeze_speed_kpa_per_s", "squeeze_speed_kpa_per_s requires squeeze_kpa");
  if (!given) return;
  (void)map.child("squeeze_speed_kpa_per_s", true);
  if (!std::isfinite(step.bounds.squeeze_max_kpa)) {
    step.bounds.squeeze_max_kpa = step.squeeze.by_kpa;
  } else if (step.bounds.squeeze_max_kpa < step.squeeze.by_kpa) {
    map.report("squeeze_max_kpa", "squeeze_max_kpa is below squeeze_kpa");
  }
}

void read_grip(MapReader& map, Step& step) {
  const SequenceKeys& keys = sequence_keys();
  read_target(map, step.target);
  read_keys(map, keys.bounds, step.bounds);
  read_squeeze(map, step);
  read_keys(map, keys.grip, step);
  read_map(map, "verify", true, keys.verify, step.verify,
           [&](MapReader& inner) { read_evidence(inner, step.verify); });
}

void read_hold(MapReader& map, Step& step) {
  const SequenceKeys& keys = sequence_keys();
  read_keys(map, keys.hold_time, step);
  const bool until = map.has("until");
  if (until && map.has("hold_s"))
    map.report("hold_s", "a hold step has `hold_s` or `until: release`, not both");
  if (until && map.choice("until", {"release"}) == 0) step.hold_s = infinite;
  (void)map.child("hold_s", !until);
  read_keys(map, keys.bounds, step.bounds);
  read_keys(map, keys.hold, step);
}

void read_release(MapReader& map, Step& step) {
  step.target.at_rest = !map.has("pressure_kpa");
  read_keys(map, sequence_keys().release_kpa, step.target);
  read_ramp(map, step.target);
  read_keys(map, sequence_keys().release, step);
}

/// Reads the points of a pressure profile. The number of points has no limit of its own; the largest number
/// of values in a document limits it.
void read_points(MapReader& map, std::vector<Point>& points) {
  for (const Node* item : map.sequence("points", true)) {
    MapReader inner = map.inner(*item, "point");
    Point point;
    read_keys(inner, sequence_keys().point, point);
    if (points.empty() ? point.time_s != 0 : point.time_s < points.back().time_s) {
      inner.report("time_s", points.empty()
                                 ? "the first point must be at time_s: 0"
                                 : "time_s of a point must not be below time_s of the previous point");
    }
    points.push_back(point);
  }
  if (points.size() < 2 && map.has("points")) map.report("points", "a profile needs at least two points");
}

/// Reads the profile of a pressure step: a test signal, or points between which the pressure is linear.
void read_profile(MapReader& map, Profile& profile) {
  const bool has_signal = map.has("signal");
  const bool has_points = map.has("points");
  if (has_signal && has_points) map.report("signal", "a pressure step has points or a signal, not both");
  read_keys(map, sequence_keys().signal, profile);
  if (has_signal) read_keys(map, sequence_keys().scale, profile);
  if (has_points || !has_signal) read_points(map, profile.points);
  read_keys(map, sequence_keys().cycles, profile);
  if (profile.cycles > 1 && !profile.points.empty() &&
      profile.points.front().pressure_kpa != profile.points.back().pressure_kpa) {
    map.report("cycles", "the last point of a repeated profile must have the pressure of the first point");
  }
}

void read_body(MapReader& map, Step& step) {
  switch (step.kind) {
    case StepKind::move:
      return read_move(map, step);
    case StepKind::grip:
      return read_grip(map, step);
    case StepKind::hold:
      return read_hold(map, step);
    case StepKind::release:
      return read_release(map, step);
    case StepKind::track:
      read_keys(map, sequence_keys().track, step.sine);
      break;
    case StepKind::pressure:
      read_profile(map, step.profile);
      break;
  }
  read_keys(map, sequence_keys().bounds, step.bounds);
  read_on_contact(map, step, OnContact::ignore);
}

Step read_step(MapReader& sequence, const Node& node, std::size_t number) {
  static const std::vector<std::string> kinds = step_names.names();
  Step step;
  step.at = node.at;
  const std::string shape = "a step is a list item with one key: " + enumerated(kinds, " or ");
  if (node.kind != Node::Kind::map || node.entries.size() != 1) {
    sequence.report(node.at, shape, "  - move: {pressure_kpa: 20, duration_s: 1}");
    return step;
  }
  const Node::Entry& entry = node.entries.front();
  const std::optional<StepKind> kind = step_names.find(entry.key);
  if (!kind) {
    const std::string near = document::nearest(entry.key, kinds);
    sequence.report(entry.key_at, "unknown kind of step '" + entry.key + "'; " + shape,
                    near.empty() ? "" : "did you mean '" + near + "'?");
    return step;
  }
  step.kind = *kind;
  step.name = entry.key;
  MapReader map = sequence.inner(entry.value, "step " + std::to_string(number) + " (" + entry.key + ")");
  read_keys(map, sequence_keys().step, step);
  step.channels = read_channel_names(map);
  read_body(map, step);
  return step;
}

Sequence read_file(const Document& document, Problems& problems) {
  Sequence result;
  result.file = document.file;
  result.text = document.text;
  MapReader map(document, document.root, problems, "the sequence");
  read_keys(map, sequence_keys().sequence, result);
  result.channels = read_channel_names(map);
  const auto items = map.sequence("steps", true);
  if (items.size() > most_steps) map.report("steps", "more than " + std::to_string(most_steps) + " steps");
  for (std::size_t i = 0; i < std::min(items.size(), most_steps); ++i)
    result.steps.push_back(read_step(map, *items[i], i + 1));
  if (items.empty() && map.has("steps")) map.report("steps", "a sequence needs at least one step");
  return result;
}

/// Returns true if the document has errors. Parsing continues after an error, so a document can be marked
/// complete although it has errors.
bool refused(const Document& document, const Problems& problems) {
  return !document.complete ||
         std::any_of(problems.list().begin(), problems.list().end(),
                     [&](const document::Problem& problem) { return problem.file == document.file; });
}

}  // namespace

std::optional<Sequence> read_with(const document::Document& document,
                                  const std::vector<Parameter>& parameters, document::Problems& problems) {
  const std::size_t before = problems.size();
  const document::Document bound = with_values(document, parameters, problems);
  Sequence sequence = read_file(bound, problems);
  if (problems.size() != before) return std::nullopt;
  sequence.parameters = parameters;
  return sequence;
}

std::optional<Sequence> read_sequence(const document::Document& document, document::Problems& problems,
                                      std::span<const Argument> arguments) {
  const std::size_t before = problems.size();
  std::vector<Parameter> parameters = read_parameters(document, problems);
  auto sequence = read_with(document, parameters, problems);
  if (problems.size() != before || refused(document, problems)) return std::nullopt;
  const Judge judge = [&document](const std::vector<Parameter>& values) {
    Problems found;
    static_cast<void>(read_with(document, values, found));
    return found;
  };
  blame_ends(document, parameters, judge, problems);
  set_values(arguments, document, parameters, problems);
  if (problems.size() != before) return std::nullopt;
  if (arguments.empty()) return sequence;
  blame_values(document, parameters, judge, problems);
  return problems.size() == before ? read_with(document, parameters, problems) : std::nullopt;
}

std::optional<Sequence> load_sequence(const std::string& path, document::Problems& problems,
                                      std::span<const Argument> arguments) {
  const std::size_t before = problems.size();
  const document::Document document = document::parse_file(path, problems);
  if (!document.complete && document.root.kind == document::Node::Kind::null) return std::nullopt;
  auto sequence = read_sequence(document, problems, arguments);
  return problems.size() == before ? std::move(sequence) : std::nullopt;
}

}  // namespace softgrip::control
