#include "simulation/emulator/server.h"

#include <charconv>
#include <nlohmann/json.hpp>

namespace softgrip::simulation {
namespace {

// Predefined objects. A stone is wide, so the fingers touch the stone at 12 mm. A screw head is narrower, so
// the fingers touch the screw head at 17 mm. The screw head is also stiffer than the stone.
constexpr simulation::PlantObject stone{12, 0.1};
constexpr simulation::PlantObject screw{17, 0.05};

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

nlohmann::ordered_json status_of(const Finger& finger) {
  const simulation::Plant& plant = finger.plant();
  nlohmann::ordered_json status;
  status["channel"] = finger.name();
  status["pressure_command_kpa"] = plant.held_command_kpa();
  status["pressure_kpa"] = plant.pressure_kpa();
  status["displacement_mm"] = plant.displacement_mm();
  status["object"] = finger.has_object();
  return status;
}

std::string status_of(const Emulator& emulator) {
  nlohmann::ordered_json status;
  status["time_s"] = static_cast<double>(emulator.now()) * 1e-9;
  status["requests"] = emulator.requests();
  status["commanded"] = emulator.commanded();
  status["watchdog_tripped"] = emulator.tripped();
  status["watchdog_trips"] = emulator.watchdog_trips();
  status["faults"] = nlohmann::ordered_json::array();
  const FaultSchedule& faults = emulator.faults();
  for (std::size_t i = 0; i < faults.faults().size(); ++i) {
    if (faults.active(i)) status["faults"].push_back(faults.faults()[i].name);
  }
  status["channels"] = nlohmann::ordered_json::array();
  for (const Finger& finger : emulator.fingers()) status["channels"].push_back(status_of(finger));
  return status.dump();
}

ControlAnswer known_fault(bool known, std::string_view name) {
  if (known) return {"ok"};
  return {"error: no fault is named '" + std::string(name) + "'"};
}

ControlAnswer control_object(Emulator& emulator, Nanoseconds now, std::string_view what) {
  if (what == "out") return known_fault(emulator.trigger(Emulator::object_out, now), Emulator::object_out);
  if (what == "back") return known_fault(emulator.clear(Emulator::object_out, now), Emulator::object_out);
  const auto object = object_named(what);
  if (!object) return {"error: expected out, back, stone, screw or POSITION_MM[:YIELDING]"};
  emulator.advance(now);
  emulator.set_object(object);
  return {"ok"};
}

}  // namespace

std::optional<simulation::PlantObject> object_named(std::string_view text) {
  if (text == "stone") return stone;
  if (text == "screw") return screw;
  simulation::PlantObject object;
  const std::size_t colon = text.find(':');
  const auto position_mm = number(text.substr(0, colon));
  if (!position_mm || !(*position_mm >= 0 && *position_mm <= 1000)) return std::nullopt;
  object.position_mm = *position_mm;
  if (colon != std::string_view::npos) {
    const auto yielding = number(text.substr(colon + 1));
    if (!yielding || !(*yielding >= 0 && *yielding <= 1)) return std::nullopt;
    object.yielding = *yielding;
  }
  return object;
}

ControlAnswer control(Emulator& emulator, Nanoseconds now, std::string_view line) {
  const std::size_t space = line.find(' ');
  const std::string_view word = line.substr(0, space);
  const std::string_view rest = space == std::string_view::npos ? std::string_view{} : line.substr(space + 1);
  if (word == "status") {
    emulator.advance(now);
    return {status_of(emulator)};
  }
  if (word == "quit") return {"ok", true};
  if (word == "fault") return known_fault(emulator.trigger(rest, now), rest);
  if (word == "clear") return known_fault(emulator.clear(rest, now), rest);
  if (word == "object") return control_object(emulator, now, rest);
  return {"error: expected status, fault, clear, object or quit"};
}

}  // namespace softgrip::simulation
