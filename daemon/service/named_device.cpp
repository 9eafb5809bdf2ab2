#include "daemon/service/named_device.h"

#include <algorithm>
#include <variant>

#include "drivers/gpio/gpio_lines.h"
#include "drivers/iio/iio_device.h"

namespace softgrip::daemon {

namespace {

std::optional<NamedDevice> named_chip(const rig::RigFile& rig, const std::string& device,
                                      const std::filesystem::path& chips) {
  if (!rig.gpio) return std::nullopt;
  std::vector<ComputerDevice> there = drivers::chips_in(chips);
  const auto is_it = [&](const ComputerDevice& chip) { return chip.node == device; };
  if (std::none_of(there.begin(), there.end(), is_it))
    there.push_back({device, {}, {}});  // the system does not list the device, so its name is used alone
  const auto& lines = rig.gpio->lines;
  const bool named = std::any_of(lines.begin(), lines.end(), [&](const drivers::GpioLineSettings& line) {
    const auto found = only_device(there, line.chip, "GPIO chip");
    return found && is_it(*found);
  });
  return named ? std::optional(NamedDevice{}) : std::nullopt;
}

std::optional<NamedDevice> named_converter(const rig::RigFile& rig, const std::string& device) {
  const auto* const converters = std::get_if<drivers::IioSettings>(&rig.board);
  if (converters == nullptr) return std::nullopt;
  const auto there = drivers::converters_in(converters->root);
  const auto is_it = [&](const drivers::IioTerminal& terminal) {
    const auto found = only_device(there, terminal.device, "converter");
    return found && found->node == device;
  };
  const bool read = std::any_of(converters->inputs.begin(), converters->inputs.end(), is_it);
  NamedDevice named;
  std::vector<drivers::IioTerminal> outputs = converters->outputs;
  if (converters->heartbeat) outputs.push_back(converters->heartbeat->terminal);
  for (const drivers::IioTerminal& output : outputs) {
    if (!is_it(output)) continue;
    named.written.push_back("out_" + output.channel + "_raw");
    const std::string powerdown =
        drivers::powerdown_of(std::filesystem::path(converters->root) / device, output.channel);
    if (!powerdown.empty()) named.written.push_back(powerdown);
  }
  return read || !named.written.empty() ? std::optional(named) : std::nullopt;
}

}  // namespace

std::optional<NamedDevice> named_device(const rig::RigFile& rig, const std::string& device,
                                        const std::filesystem::path& chips) {
  if (device.starts_with("gpiochip")) return named_chip(rig, device, chips);
  if (device.starts_with("iio:device")) return named_converter(rig, device);
  return std::nullopt;
}

}  // namespace softgrip::daemon
