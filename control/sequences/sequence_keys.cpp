#include "control/sequences/sequence_keys.h"

#include <string>
#include <vector>

namespace softgrip::control {

namespace {

using document::Allowed;
using document::facts_of;
using document::KeyFacts;
using document::MapReader;
using document::optional;
using document::required;

// Ranges that no rig of soft fingers exceeds. A rig has narrower limits, and prepare() checks a sequence
// against these limits.
const Allowed mm{-100, 200};
const Allowed kpa{-100, 1000};
const Allowed squeeze_kpa{0.1, 1000};
const Allowed speed{0.01, 1000};
const Allowed short_s{0, 600};
const Allowed long_s{0, 86400};
const Allowed window_s{0.02, 60};
const Allowed cycles{1, 10'000};
/// Permitted range of the numbers in `range` and `default` of a parameter.
const Allowed any_number{-1e6, 1e6};

void declare_file(SequenceKeys& keys) {
  keys.sequence = {
      required("name", &Sequence::name, {}, "name of the sequence"),
      optional("about", &Sequence::about, {}, "one line of description"),
      {"channels", "list of names", "all fingers of the rig", "names of the fingers that take part"},
      optional("interlock", &Sequence::interlock, interlock_names,
               "`start`: while the interlock is open, a start is refused. `always`: an open interlock also "
               "stops the running sequence"),
      {"parameters", "map", "none", "at most 16 [parameters](#parameters), which a start request may set"},
      {"steps", "list", "", "1 to 200 [steps](#kinds-of-steps)"}};
  keys.parameter = {
      optional("unit", &Parameter::unit, {{parameter_units.begin(), parameter_units.end()}},
               "unit of the parameter; `none` for a plain number", "end of the name"),
      required("about", &Parameter::about, {}, "one sentence of description"),
      {{"range", "two numbers", "", "lowest and highest allowed value"},
       [](MapReader& reader, const KeyFacts& key, Parameter& parameter) {
         const std::vector<double> ends = reader.numbers(key.name, 2, any_number.range);
         parameter.lower = ends[0];
         parameter.upper = ends[1];
       }},
      required("default", &Parameter::default_value, any_number, "value if the start request sets none")};
  keys.step = {optional("name", &Step::name, {}, "description of the step", "kind of the step"),
               {"channels", "list of names", "all channels of the sequence", "channels that take part"}};
}

void declare_motion(SequenceKeys& keys) {
  keys.target_mm = {optional("displacement_mm", &Target::value, mm, "target displacement", "none")};
  keys.target_kpa = {required("pressure_kpa", &Target::value, kpa,
                              "target pressure; a step has one of `pressure_kpa` and `displacement_mm`")};
  const std::string fastest = "highest speed of the ramp, in the unit of the target";
  keys.ramp = {optional("speed_mm_per_s", &Target::speed, speed, fastest, "none"),
               optional("speed_kpa_per_s", &Target::speed, speed, fastest, "none"),
               optional("duration_s", &Target::duration_s, {0.01, 600},
                        "duration of the ramp, in place of its speed", "none")};
  keys.release_kpa = {optional("pressure_kpa", &Target::value, kpa, "end of the ramp", "rest pressure")};
  keys.bounds = {
      optional("pressure_max_kpa", &Bounds::pressure_max_kpa, kpa,
               "highest command; a value below the `rest_kpa` of the channel is an error"),
      optional("squeeze_max_kpa", &Bounds::squeeze_max_kpa, squeeze_kpa,
               "highest difference of the command and the free-motion pressure at the present displacement")};
  keys.on_contact = {optional("on_contact", &Step::on_contact, {on_contact_names, OnContact::ignore},
                              "only for `move`, `track` and `pressure`: reaction to contact", "see below")};
}

void declare_steps(SequenceKeys& keys) {
  const auto timeout =
      required("timeout_s", &Step::timeout_s, short_s, "time within which the step must succeed");
  const auto retries =
      optional("retries", &Step::retries, {0, 10}, "largest number of repetitions of a failed step");
  const auto on_fail = required("on_fail", &Step::on_fail, on_fail_names,
                                "[reaction](#when-a-step-fails) if the last attempt fails");
  keys.tolerance = {timeout, retries, on_fail};
  keys.failing_contact = {retries, on_fail};
  const std::string settling = "waiting time after the ramp";
  keys.move = {optional("settle_s", &Step::settle_s, short_s, settling),
               optional("tolerance_mm", &Step::tolerance_mm, {0.01, 50},
                        "largest distance from `displacement_mm` during `settle_s`")};
  keys.grip = {required("settle_s", &Step::settle_s, short_s, settling),
               {"verify", "map", "", "[verification of the grip](#verification)"},
               timeout,
               retries,
               on_fail};
  keys.squeeze = {
      optional("squeeze_kpa", &Squeeze::by_kpa, squeeze_kpa, "gripping pressure after contact", "none"),
      optional("squeeze_speed_kpa_per_s", &Squeeze::speed_kpa_per_s, speed,
               "rate at which the gripping pressure rises; required with `squeeze_kpa`", "none")};
  keys.verify = {required("by", &Verify::by, verify_by_names, "evidence of a part"),
                 required("window_s", &Verify::window_s, window_s,
                          "time for which the evidence must be present without interruption")};
  keys.verify_position = {optional("displacement_min_mm", &Verify::displacement_min_mm, mm,
                                   "lower limit of the displacement when a part is held"),
                          optional("displacement_max_mm", &Verify::displacement_max_mm, mm,
                                   "upper limit of the displacement when a part is held")};
  keys.verify_pressure = {optional("pressure_max_kpa", &Verify::pressure_max_kpa, kpa,
                                   "upper limit of the pressure when a part is held"),
                          optional("pressure_min_kpa", &Verify::pressure_min_kpa, kpa,
                                   "lower limit of the pressure when a part is held", "none")};
  keys.hold_time = {{"until", "`release`", "none", "in place of `hold_s`: hold until a release is requested"},
                    optional("hold_s", &Step::hold_s, long_s, "duration of the step", "none")};
  keys.hold = {required("reverify_every_s", &Step::reverify_every_s, window_s, "interval of verifications"),
               on_fail};
  keys.release = {required("purge_s", &Step::purge_s, short_s, "time at the rest pressure after the ramp"),
                  timeout, on_fail};
}

void declare_profiles(SequenceKeys& keys) {
  keys.track = {required("mean_mm", &Sine::mean_mm, mm, "mean displacement"),
                required("amplitude_mm", &Sine::amplitude_mm, {0.001, 100}, "amplitude"),
                required("frequency_hz", &Sine::frequency_hz, {0.001, 50}, "frequency"),
                required("cycles", &Sine::cycles, cycles, "number of periods")};
  keys.signal = {
      optional("signal", &Profile::signal, model::signal_names, "test signal, in place of `points`")};
  keys.scale = {
      optional("scale", &Profile::scale, {0.01, 20}, "only with `signal`: factor of the pressures")};
  keys.points = {{"points", "list", "", "points from time 0; the pressure between two points is linear"}};
  keys.cycles = {
      optional("cycles", &Profile::cycles, cycles, "number of times that the profile is executed")};
  keys.point = {required("time_s", &Point::time_s, long_s,
                         "time of the point; two points with equal times are a pressure step"),
                required("pressure_kpa", &Point::pressure_kpa, kpa, "pressure of the point")};
}

}  // namespace

const SequenceKeys& sequence_keys() {
  static const SequenceKeys keys = [] {
    SequenceKeys all;
    for (const auto declare : {declare_file, declare_motion, declare_steps, declare_profiles}) declare(all);
    return all;
  }();
  return keys;
}

document::KeyTables sequence_tables() {
  const SequenceKeys& keys = sequence_keys();
  return {{"sequence", facts_of(keys.sequence)},
          {"step", facts_of(keys.step)},
          {"parameter", facts_of(keys.parameter)},
          {"target", facts_of(keys.target_mm, keys.target_kpa, keys.ramp)},
          {"bounds", facts_of(keys.bounds, keys.on_contact)},
          {"move", facts_of(keys.move)},
          {"tolerance", facts_of(keys.tolerance)},
          {"grip", facts_of(keys.grip, keys.squeeze)},
          {"verify", facts_of(keys.verify, keys.verify_position, keys.verify_pressure)},
          {"hold", facts_of(keys.hold_time, keys.hold)},
          {"release", facts_of(keys.release_kpa, keys.release)},
          {"track", facts_of(keys.track)},
          {"pressure", facts_of(keys.signal, keys.scale, keys.points, keys.cycles)},
          {"point", facts_of(keys.point)}};
}

}  // namespace softgrip::control
