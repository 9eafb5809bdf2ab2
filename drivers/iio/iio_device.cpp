#include "drivers/iio/iio_device.h"

#include <utility>

namespace softgrip::drivers {

std::vector<ComputerDevice> converters_in(const std::filesystem::path& root) {
  std::vector<ComputerDevice> converters = devices_in(root, "iio:device");
  for (ComputerDevice& converter : converters) {
    const std::filesystem::path folder = root / converter.node;
    std::vector<DeviceWord> of_bus = std::exchange(converter.words, {});
    converter.add("label", first_line(folder / "label"));
    converter.add("name", first_line(folder / "name"));
    converter.add("serial number", first_line(folder / "serialnumber"));
    for (DeviceWord& word : of_bus) converter.words.push_back(std::move(word));
  }
  return converters;
}

std::string identity_of(const ComputerDevice& converter) {
  const std::string name = converter.word("name");
  return converter.word("address").empty() ? name : name + " at " + converter.folder.parent_path().string();
}

std::string type_of(const std::string& channel) {
  return channel.substr(0, channel.find_first_of("0123456789"));
}

std::string powerdown_of(const std::filesystem::path& folder, const std::string& channel) {
  std::error_code error;
  for (const std::string& whose : {channel, type_of(channel)}) {
    const std::string name = "out_" + whose + "_powerdown";
    if (std::filesystem::exists(folder / name, error)) return name;
  }
  return {};
}

}  // namespace softgrip::drivers
