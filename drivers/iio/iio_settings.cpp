#include "drivers/iio/iio_settings.h"

#include <algorithm>
#include <limits>

namespace softgrip::drivers {

std::optional<ElectricalUnit> unit_of_channel(std::string_view channel) noexcept {
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

ModuleTerminals terminals_of(const IioSettings& settings) {
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
