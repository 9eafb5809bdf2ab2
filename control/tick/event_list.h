#pragma once
// The events of one tick, written into its fixed-size output.

#include <cstddef>
#include <cstdint>

#include "control/tick/rig_controller.h"

namespace softgrip::control {

/// `Event::channel` of what concerns the whole rig.
inline constexpr std::uint8_t whole_rig = 0xff;

class EventList {
 public:
  explicit EventList(TickOutput& output) noexcept : output_(output) {}

  void add(const Event& event) noexcept {
    if (output_.event_count < output_.events.size()) {
      output_.events[output_.event_count++] = event;
    } else {
      ++output_.events_lost;
    }
  }

  /// `detail` is one of the enumerations that Event::detail names.
  template <class Detail>
  void add(Event::Kind kind, Detail detail, std::uint32_t request = 0, double value = 0) noexcept {
    add(Event{kind, whole_rig, static_cast<std::uint16_t>(detail), request, value, GripEvidence::none});
  }

  template <class Detail>
  void add_of_channel(std::size_t channel, Event::Kind kind, Detail detail, std::uint32_t request = 0,
                      double value = 0) noexcept {
    add(Event{kind, static_cast<std::uint8_t>(channel), static_cast<std::uint16_t>(detail), request, value,
              GripEvidence::none});
  }

 private:
  TickOutput& output_;
};

}  // namespace softgrip::control
