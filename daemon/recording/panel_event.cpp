// What the digital lines had to tell, in words.

#include "daemon/recording/event_log.h"

namespace softgrip::daemon {

namespace {

using Kind = PanelEvent::Kind;

const char* text_of(Kind kind) {
  switch (kind) {
    case Kind::emergency_stop_pressed:
      return "The emergency stop is pressed.";
    case Kind::emergency_stop_released:
      return "The emergency stop is released; acknowledge to make the rig ready.";
    case Kind::part_in_position:
      return "A part is in position.";
    case Kind::part_away:
      return "No part is in position.";
    case Kind::enable_on:
      return "The enable output is on.";
    case Kind::enable_off:
      return "The enable output is off.";
    case Kind::loop_hangs:
      return "The loop does not tick: the enable output was dropped.";
    case Kind::gpio_lost:
      return "The GPIO chip failed: its lines are lost until the daemon starts again.";
  }
  return "?";
}

Severity severity_of(Kind kind) {
  if (kind == Kind::gpio_lost || kind == Kind::loop_hangs) return Severity::error;
  return kind == Kind::emergency_stop_pressed ? Severity::warning : Severity::information;
}

}  // namespace

EventEntry describe(const PanelEvent& event) {
  EventEntry entry;
  entry.kind = name_of(event.kind);
  entry.severity = severity_of(event.kind);
  entry.text = text_of(event.kind);
  return entry;
}

std::string_view name_of(Kind kind) noexcept {
  switch (kind) {
    case Kind::emergency_stop_pressed:
      return "emergency_stop_pressed";
    case Kind::emergency_stop_released:
      return "emergency_stop_released";
    case Kind::part_in_position:
      return "part_in_position";
    case Kind::part_away:
      return "part_away";
    case Kind::enable_on:
      return "enable_on";
    case Kind::enable_off:
      return "enable_off";
    case Kind::loop_hangs:
      return "loop_hangs";
    case Kind::gpio_lost:
      return "gpio_lost";
  }
  return "?";
}

}  // namespace softgrip::daemon
