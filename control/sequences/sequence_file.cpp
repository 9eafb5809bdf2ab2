#include "control/sequences/sequence_file.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "control/sequences/parameters.h"
#include "control/sequences/profile_reader.h"
#include "document/reader.h"

namespace softgrip::control {

namespace {

using document::Document;
using document::MapReader;
using document::Node;
using document::Problems;
using step_ranges::displacement_mm;
using step_ranges::long_time_s;
using step_ranges::pressure_kpa;
using step_ranges::ramp_s;
using step_ranges::short_time_s;
using step_ranges::speed;
using step_ranges::squeeze_kpa;
using step_ranges::window_s;

constexpr std::size_t most_steps = 200;

/// Reads the parts of one sequence file. After a problem, each function reports the problem and continues
/// with the next key.
class FileReader {
 public:
  FileReader(const Document& document, Problems& problems) : document_(document), problems_(problems) {}

  Sequence sequence() {
    Sequence result;
    result.file = document_.file;
    result.text = document_.text;
    MapReader map(document_, document_.root, problems_, "the sequence");
    result.name = map.text("name");
    result.about = map.optional_text("about").value_or("");
    result.channels = channel_names(map);
    result.interlock = map.optional_choice("interlock", interlock_names).value_or(result.interlock);
    static_cast<void>(map.child("parameters", false));  // read_parameters() has already read this key
    const auto items = map.sequence("steps", true);
    if (items.size() > most_steps) {
      map.report("steps", "more than " + std::to_string(most_steps) + " steps");
    }
    for (std::size_t i = 0; i < std::min(items.size(), most_steps); ++i) {
      result.steps.push_back(step(*items[i], i + 1));
    }
    if (items.empty() && map.has("steps")) {
      map.report("steps", "a sequence needs at least one step");
    }
    return result;
  }

 private:
  std::vector<std::string> channel_names(MapReader& map) {
    std::vector<std::string> list;
    if (!map.has("channels")) return list;
    for (const Node* item : map.sequence("channels", true)) {
      if (item->kind != Node::Kind::scalar || item->scalar.empty()) {
        problems_.add(document_.problem(item->at, "expected the name of a channel"));
      } else if (std::find(list.begin(), list.end(), item->scalar) != list.end()) {
        problems_.add(document_.problem(item->at, "channel '" + item->scalar + "' is listed twice"));
      } else {
        list.push_back(item->scalar);
      }
    }
    if (list.empty()) {
      map.report("channels", "name at least one channel", "to use all channels of the rig, omit the key");
    }
    return list;
  }

  Step step(const Node& node, std::size_t number) {
    static const std::vector<std::string> kinds = step_names.names();
    Step result;
    result.at = node.at;
    const std::string shape =
        "a step is a list item with one key: move, grip, hold, release, track or pressure";
    if (node.kind != Node::Kind::map || node.entries.size() != 1) {
      problems_.add(document_.problem(node.at, shape, "  - move: {pressure_kpa: 20, duration_s: 1}"));
      return result;
    }
    const Node::Entry& entry = node.entries.front();
    const auto kind = std::find(kinds.begin(), kinds.end(), entry.key);
    if (kind == kinds.end()) {
      const std::string near = document::nearest(entry.key, kinds);
      problems_.add(document_.problem(entry.key_at, "unknown kind of step '" + entry.key + "'; " + shape,
                                      near.empty() ? "" : "did you mean '" + near + "'?"));
      return result;
    }
    result.kind = static_cast<StepKind>(kind - kinds.begin());
    MapReader map(document_, entry.value, problems_,
                  "step " + std::to_string(number) + " (" + entry.key + ")");
    result.name = map.optional_text("name").value_or(entry.key);
    result.channels = channel_names(map);
    body(map, result);
    map.finish();
    return result;
  }

  void body(MapReader& map, Step& step) {
    switch (step.kind) {
      case StepKind::move:
        target(map, step.target);
        step.settle_s = map.optional_number("settle_s", short_time_s).value_or(0);
        tolerance(map, step);
        bounds(map, step.bounds);
        on_contact(map, step, step.tolerance_mm ? OnContact::fail : OnContact::hold);
        break;
      case StepKind::grip:
        target(map, step.target);
        bounds(map, step.bounds);
        squeeze(map, step);
        step.settle_s = map.number("settle_s", short_time_s);
        step.verify = verify(map);
        step.timeout_s = map.number("timeout_s", short_time_s);
        step.retries = retries(map);
        step.on_fail = on_fail(map);
        break;
      case StepKind::hold:
        how_long(map, step);
        bounds(map, step.bounds);
        step.reverify_every_s = map.number("reverify_every_s", window_s);
        step.on_fail = on_fail(map);
        break;
      case StepKind::release:
        release(map, step);
        break;
      case StepKind::track:
        step.sine.mean_mm = map.number("mean_mm", displacement_mm);
        step.sine.amplitude_mm = map.number("amplitude_mm", {0.001, 100});
        step.sine.frequency_hz = map.number("frequency_hz", {0.001, 50});
        step.sine.cycles = static_cast<std::uint32_t>(map.integer("cycles", {1, 10'000}));
        bounds(map, step.bounds);
        on_contact(map, step, OnContact::ignore);
        break;
      case StepKind::pressure:
        read_profile(map, document_, problems_, step.profile);
        bounds(map, step.bounds);
        on_contact(map, step, OnContact::ignore);
        break;
    }
  }

  /// Reads the target of a step: displacement_mm or pressure_kpa, and the speed or duration.
  void target(MapReader& map, Target& target) {
    const bool displacement = map.has("displacement_mm");
    const bool pressure = map.has("pressure_kpa");
    target.quantity = displacement ? Target::Quantity::displacement_mm : Target::Quantity::pressure_kpa;
    if (displacement && pressure) {
      map.optional_number("pressure_kpa", pressure_kpa);
      map.report("pressure_kpa", "a step has a target in displacement_mm or in pressure_kpa, not in both");
    }
    target.value = displacement ? map.number("displacement_mm", displacement_mm)
                                : map.number("pressure_kpa", pressure_kpa);
    ramp(map, target);
  }

  void ramp(MapReader& map, Target& target) {
    const bool displacement = target.quantity == Target::Quantity::displacement_mm;
    const std::string_view own = displacement ? "speed_mm_per_s" : "speed_kpa_per_s";
    const std::string_view other = displacement ? "speed_kpa_per_s" : "speed_mm_per_s";
    const auto by_speed = map.optional_number(own, speed);
    const auto by_duration = map.optional_number("duration_s", ramp_s);
    if (map.optional_number(other, speed)) {
      map.report(other, "the speed and the target have different units", "write " + std::string(own));
    } else if (by_speed && by_duration) {
      map.report("duration_s", "a ramp has a speed or a duration, not both");
    } else if (displacement && !by_speed && !by_duration) {
      map.report("displacement_mm", "a target in displacement_mm requires speed_mm_per_s or duration_s");
    }
    target.speed = by_speed.value_or(0);
    target.duration_s = by_duration.value_or(0);
  }

  /// Reads the tolerance of a move. A move with a tolerance can fail. Therefore, the file must give on_fail
  /// for such a move.
  void tolerance(MapReader& map, Step& step) {
    step.tolerance_mm = map.optional_number("tolerance_mm", {0.01, 50});
    if (!step.tolerance_mm) return;
    if (step.target.quantity != Target::Quantity::displacement_mm) {
      map.report("tolerance_mm", "tolerance_mm requires a target in displacement_mm");
    }
    step.timeout_s = map.number("timeout_s", short_time_s);
    step.retries = retries(map);
    step.on_fail = on_fail(map);
  }

  static void bounds(MapReader& map, Bounds& bounds) {
    bounds.pressure_max_kpa =
        map.optional_number("pressure_max_kpa", pressure_kpa).value_or(bounds.pressure_max_kpa);
    bounds.squeeze_max_kpa =
        map.optional_number("squeeze_max_kpa", squeeze_kpa).value_or(bounds.squeeze_max_kpa);
  }

  /// Reads the action on contact. If a contact makes the step fail, the file must also give on_fail. If the
  /// move has a tolerance, tolerance() has already read on_fail.
  void on_contact(MapReader& map, Step& step, OnContact otherwise) {
    constexpr std::array permitted{OnContact::hold, OnContact::grip, OnContact::fail, OnContact::ignore};
    const auto choice =
        map.optional_choice("on_contact", on_contact_names, std::span<const OnContact>(permitted));
    step.on_contact_stated = choice.has_value();
    step.on_contact = choice.value_or(otherwise);
    const bool says_how = step.tolerance_mm.has_value();
    if (step.on_contact != OnContact::fail || says_how) return;
    step.retries = retries(map);
    step.on_fail = on_fail(map);
  }

  /// Reads the gripping pressure of a step. If the step has no squeeze_max_kpa, the final gripping pressure
  /// squeeze_kpa is also the upper limit.
  static void squeeze(MapReader& map, Step& step) {
    const auto by = map.optional_number("squeeze_kpa", squeeze_kpa);
    if (!by) {
      if (map.optional_number("squeeze_speed_kpa_per_s", speed))
        map.report("squeeze_speed_kpa_per_s", "squeeze_speed_kpa_per_s requires squeeze_kpa");
      return;
    }
    step.squeeze = {*by, map.number("squeeze_speed_kpa_per_s", speed)};
    if (!std::isfinite(step.bounds.squeeze_max_kpa)) {
      step.bounds.squeeze_max_kpa = *by;
    } else if (step.bounds.squeeze_max_kpa < *by) {
      map.report("squeeze_max_kpa", "squeeze_max_kpa is below squeeze_kpa");
    }
  }

  static void how_long(MapReader& map, Step& step) {
    const bool until = map.optional_choice("until", {"release"}).has_value();
    if (until && map.optional_number("hold_s", long_time_s)) {
      map.report("hold_s", "a hold step has `hold_s` or `until: release`, not both");
    }
    step.hold_s = until ? std::numeric_limits<double>::infinity() : map.number("hold_s", long_time_s);
  }

  Verify verify(MapReader& map) {
    Verify result;
    const Node* node = map.child("verify", true);
    if (node == nullptr) return result;
    MapReader inner(document_, *node, problems_, "verify");
    result.by = inner.choice("by", verify_by_names);
    result.window_s = inner.number("window_s", window_s);
    if (result.by == VerifyBy::pressure) {
      pressure_bound(inner, result);
    } else {
      position_window(inner, result);
    }
    inner.finish();
    return result;
  }

  /// Reads the pressure bound of a verification by pressure. A grip above the rest pressure needs a lower
  /// bound, and a grip below the rest pressure needs an upper bound.
  void pressure_bound(MapReader& map, Verify& verify) {
    const auto most = map.optional_number("pressure_max_kpa", pressure_kpa);
    if (!most) {
      verify.pressure_min_kpa = map.number("pressure_min_kpa", pressure_kpa);
      return;
    }
    verify.pressure_max_kpa = *most;
    verify.pressure_min_kpa = -std::numeric_limits<double>::infinity();
    if (map.optional_number("pressure_min_kpa", pressure_kpa)) {
      map.report("pressure_max_kpa", "give either pressure_min_kpa or pressure_max_kpa, not both");
    }
  }

  void position_window(MapReader& map, Verify& verify) {
    const auto lower = map.optional_number("displacement_min_mm", displacement_mm);
    const auto upper = map.optional_number("displacement_max_mm", displacement_mm);
    verify.displacement_min_mm = lower.value_or(verify.displacement_min_mm);
    verify.displacement_max_mm = upper.value_or(verify.displacement_max_mm);
    if (verify.by == VerifyBy::position && !(lower && upper)) {
      map.report("by", "verification by position needs displacement_min_mm and displacement_max_mm");
    }
    if (lower && upper && *lower >= *upper) {
      map.report("displacement_max_mm", "displacement_max_mm must be above displacement_min_mm");
    }
  }

  std::uint32_t retries(MapReader& map) {
    return static_cast<std::uint32_t>(map.optional_integer("retries", {0, 10}).value_or(0));
  }

  /// Reads the action after a failed step. The key is required, because a default action would not be visible
  /// in the file.
  OnFail on_fail(MapReader& map) { return map.choice("on_fail", on_fail_names); }

  void release(MapReader& map, Step& step) {
    step.target.quantity = Target::Quantity::pressure_kpa;
    const auto level = map.optional_number("pressure_kpa", pressure_kpa);
    step.target.at_rest = !level;
    step.target.value = level.value_or(0);
    ramp(map, step.target);
    step.purge_s = map.number("purge_s", short_time_s);
    step.timeout_s = map.number("timeout_s", short_time_s);
    step.on_fail = on_fail(map);
  }

  const Document& document_;
  Problems& problems_;
};

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
  Sequence sequence = FileReader(bound, problems).sequence();
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
  if (document.root.kind == document::Node::Kind::null) return std::nullopt;
  auto sequence = read_sequence(document, problems, arguments);
  return problems.size() == before ? std::move(sequence) : std::nullopt;
}

}  // namespace softgrip::control
