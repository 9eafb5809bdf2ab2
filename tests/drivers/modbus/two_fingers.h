#pragma once
// Wiring that most tests of the drivers use: two fingers on the first terminals of a board.

#include <vector>

#include "drivers/board/board_map.h"
#include "drivers/board/channel_wiring.h"

namespace softgrip::drivers::test {

/// Returns the wiring of two fingers. The valves are on outputs 0 and 1, with 0 to 10 V for 0 to 100 kPa. The
/// sensors are on inputs 0 and 1, with 0 to 10 V for -5 to 45 mm; 0.1 to 9.9 V are valid, and 9.95 V is an
/// error code. With `with_pressure`, pressure sensors are on inputs 4 and 5, with 0 to 10 V for 0 to 100 kPa.
inline std::vector<ChannelWiring> two_fingers(bool with_pressure = true) {
  std::vector<ChannelWiring> wiring;
  for (std::size_t i = 0; i < 2; ++i) {
    ChannelWiring channel;
    channel.name = i == 0 ? "left" : "right";
    channel.valve = {.output = i, .unit = ElectricalUnit::volt, .scaling = {0, 0, 10, 100}};
    channel.displacement = {.input = i,
                            .unit = ElectricalUnit::volt,
                            .scaling = {0, -5, 10, 45},
                            .valid_min = 0.1,
                            .valid_max = 9.9,
                            .error_codes = {{9.95, 0.02}}};
    if (with_pressure) {
      channel.pressure = InputWiring{.input = 4 + i,
                                     .unit = ElectricalUnit::volt,
                                     .scaling = {0, 0, 10, 100},
                                     .valid_min = -0.2,
                                     .valid_max = 10,
                                     .error_codes = {}};
    }
    wiring.push_back(channel);
  }
  return wiring;
}

/// Returns two_fingers() with one thermometer for both fingers on input 2. 0 to 10 V mean 0 to 100 °C, and
/// voltages of at least 0.5 V are valid.
inline std::vector<ChannelWiring> two_fingers_and_a_thermometer() {
  std::vector<ChannelWiring> wiring = two_fingers();
  for (ChannelWiring& channel : wiring) {
    channel.temperature = InputWiring{.input = 2,
                                      .unit = ElectricalUnit::volt,
                                      .scaling = {0, 0, 10, 100},
                                      .valid_min = 0.5,
                                      .valid_max = 10,
                                      .error_codes = {}};
  }
  return wiring;
}

}  // namespace softgrip::drivers::test
