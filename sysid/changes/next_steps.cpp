#include "sysid/changes/next_steps.h"

#include <algorithm>

namespace softgrip::sysid {
namespace {

struct Steps {
  std::string_view id, words;
  std::array<std::string_view, 2> steps;
};

constexpr Steps table[] = {
    {"transport_delay",
     "the pressure begins later",
     {"Look whether the tube, a filter or the board's exchange rate was changed.",
      "Step the command with the finger's tube closed at the valve and time the pressure there."}},
    {"valve_lag",
     "the pressure follows more slowly",
     {"Look for a kinked tube and a clogged filter or silencer; check the supply pressure while it moves.",
      "Step the command with the finger's tube closed at the valve: still slow there, it is the valve."}},
    {"blocked_line",
     "the line to the finger lets less air through",
     {"Blow the tube through, look for kinks and for water in it.",
      "Swap the tube for a new one of the same length and record the same log again."}},
    {"leak",
     "pressure is lost while it should hold",
     {"Hold full pressure and listen or spray soapy water along tube, fittings and finger.",
      "Close the tube at the valve, then at the finger, and see at which end the pressure still falls."}},
    {"valve_deadband",
     "the valve ignores small changes",
     {"Command steps of 1 kPa up and down and see which of them the pressure answers.",
      "Cycle the valve fifty times over its range, or clean it, and record the same log again."}},
    {"pressure_saturation",
     "the pressure stops short",
     {"Read the supply gauge while the highest pressure is commanded.",
      "Compare the regulator's range and the board's scaling with the rig file."}},
    {"supply_sag",
     "the pressure follows a falling supply",
     {"Read the supply gauge while the compressor refills.",
      "Move other users to another line, or set the supply regulator higher, and record again."}},
    {"actuator_threshold",
     "nothing moves below a pressure",
     {"Raise the pressure slowly from zero and watch at which reading the finger begins to move.",
      "Look whether the bladder sticks together or a fold is creased; inflate it fully once and repeat."}},
    {"stiffening",
     "the finger gives way less the farther it is bent",
     {"Bend the vented finger by hand and feel whether something is in its way.",
      "Hold a gauge beside the sensor at five positions: if they agree, it is the finger."}},
    {"asymmetric_hysteresis",
     "the way back is another than the way there",
     {"Look for something that rubs on the finger or its guide in one direction.",
      "Run up and down slowly three times with the load taken off."}},
    {"rate_dependent_hysteresis",
     "fast motion costs more pressure than slow motion",
     {"Run the same stroke at three speeds and compare the loops.",
      "Look for rubbing, dried lubricant or a swollen seal, and record again."}},
    {"stress_softening",
     "the finger softened under a large load",
     {"Look in the events for a load above the usual one.",
      "Leave it vented overnight and record again: what comes back is not wear."}},
    {"slow_creep",
     "the finger creeps more over minutes",
     {"Hold full pressure for ten minutes and watch the reading.",
      "Look for a slack mounting or a layer that comes off; tighten it and record again."}},
    {"thermal_gain",
     "the gain follows the temperature",
     {"Record again at another temperature of the room.",
      "Look for a heat source beside the finger or the sensor."}},
    {"ageing",
     "the gain of the finger is another",
     {"Look at the finger for cracks and bulges, and count its cycles since the last one was fitted.",
      "Fit a new finger and record the same log: if the gain is back, it was the finger."}},
    {"contact",
     "something holds the finger back from a position on",
     {"Move the finger by hand through its range and look what it touches.",
      "Take the object or the stop away and record the same log again."}},
    {"inertia",
     "the finger rings",
     {"Tap the finger and look whether its mounting or an added mass swings.",
      "Tighten the mounting, take added masses off, and record a sharp step."}},
    {"backlash",
     "there is play between finger and sensor",
     {"Move the sensor's target by hand and feel for play.",
      "Tighten the clamp of the sensor's target and record the same log again."}},
    {"sensor_lag",
     "the reading follows more slowly",
     {"Look at the filter setting of the sensor or its amplifier.",
      "Move the target by hand quickly and compare with a second sensor."}},
    {"sensor_drift",
     "the zero of the sensor wanders",
     {"Leave the finger vented for an hour and read the zero every ten minutes.",
      "Check the sensor's clamp and cable, and let it warm up before recording."}},
    {"sensor_nonlinearity",
     "the scale of the sensor is bent",
     {"Look whether the sensor was knocked out of place or its target is askew.",
      "Hold a gauge at five positions (`softgrip diagnose --gauge`)."}},
    {"sensor_saturation",
     "the reading clips",
     {"Look whether the sensor stands too near or too far: its range must hold the whole stroke.",
      "Move the target by hand beyond the position where it clips and read."}},
    {"periodic_disturbance",
     "an oscillation that the command does not explain",
     {"Switch neighbouring machines and pumps off one by one and watch the reading.",
      "Check the sensor's shielding and ground; record with the finger vented."}},
    {"outliers",
     "single readings are wrong",
     {"Move the sensor's cable and connector while watching the reading.",
      "Swap the cable, and look in the events for bus errors at the same times."}},
};

const Steps* find(std::string_view id) {
  const auto* const found =
      std::find_if(std::begin(table), std::end(table), [&](const Steps& s) { return s.id == id; });
  return found == std::end(table) ? nullptr : found;
}

}  // namespace

std::array<std::string_view, 2> next_steps(std::string_view cause_id) {
  const Steps* const found = find(cause_id);
  return found == nullptr ? std::array<std::string_view, 2>{} : found->steps;
}

std::string_view plain_words(std::string_view cause_id) {
  const Steps* const found = find(cause_id);
  return found == nullptr ? std::string_view{} : found->words;
}

}  // namespace softgrip::sysid
