#pragma once
// Defines the settings of a board that consists of converters of this computer (iio_board.h), and the units
// of its channels.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/board/channel_wiring.h"

namespace softgrip::drivers {

/// One channel of a converter. `channel` is, for example, "voltage0", "current2", or "voltage0-voltage1" for
/// a differential channel.
struct IioTerminal {
  std::string device;  ///< a word of exactly one converter that converters_in() returns
  std::string channel;
  long raw_max = 0;  ///< for outputs: largest raw number that the converter accepts; the smallest raw number
                     ///< is 0
};

/// A heartbeat output, whose value each exchange changes. An external circuit switches off the supply of the
/// valves if the value has not changed for `timeout_s`.
struct IioHeartbeat {
  IioTerminal terminal;
  long first = 0;        ///< raw number of the second, fourth, sixth ... write
  long second = 0;       ///< raw number of the first, third, fifth ... write
  double timeout_s = 0;  ///< time-out of the external circuit [s]
};

/// Largest number of channels of a board; equal to the largest number of channels of the controller.
inline constexpr std::size_t most_channels = 16;

struct IioSettings {
  std::string root = "/sys/bus/iio/devices";
  std::vector<IioTerminal> inputs;   ///< terminals of the inputs, by the number of the input in the wiring
  std::vector<IioTerminal> outputs;  ///< terminals of the outputs, by the number of the output in the wiring
  std::optional<IioHeartbeat> heartbeat;
  std::vector<ChannelWiring> wiring;
};

/// Returns the unit that follows from the name of a channel; nothing if the channel is not a voltage, current
/// or pressure.
[[nodiscard]] inline std::optional<ElectricalUnit> unit_of_channel(std::string_view channel) noexcept {
  const auto begins = [&](std::string_view word) {
    return channel.size() > word.size() && channel.substr(0, word.size()) == word &&
           channel[word.size()] >= '0' && channel[word.size()] <= '9';
  };
  const bool plain = std::all_of(channel.begin(), channel.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
  if (plain && begins("voltage")) return ElectricalUnit::volt;
  if (plain && begins("current")) return ElectricalUnit::milliampere;
  if (plain && (begins("pressure") || channel == "pressure")) return ElectricalUnit::kilopascal;
  return std::nullopt;
}
/// Returns the terminals of an industrial I/O board with their units. The ranges in the result are unlimited,
/// because the actual ranges are unknown until the converters are open.
[[nodiscard]] inline ModuleTerminals terminals_of(const IioSettings& settings) {
  const auto terminals = [](const std::vector<IioTerminal>& from) {
    constexpr double anything = std::numeric_limits<double>::infinity();
    std::vector<Terminal> result;
    result.reserve(from.size());
    for (const IioTerminal& terminal : from) {
      result.push_back(
          {unit_of_channel(terminal.channel).value_or(ElectricalUnit::volt), -anything, anything});
    }
    return result;
  };
  return {"iio", terminals(settings.inputs), terminals(settings.outputs)};
}

}  // namespace softgrip::drivers
