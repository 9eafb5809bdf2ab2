#pragma once
// Which device of this computer a file names: one rule for converters, GPIO chips and serial adapters.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace softgrip {

/// A word by which a file may name a device.
struct DeviceWord {
  std::string kind;  ///< "label", "name", "serial number", "address"
  std::string text;
};

struct ComputerDevice {
  std::string node;               ///< the kernel's name, which may change at every start: iio:device0
  std::filesystem::path folder;   ///< in sysfs, without symbolic links; empty: not known
  std::vector<DeviceWord> words;  ///< those that stay when the node changes

  /// Adds a word, if there is one.
  void add(std::string_view kind, std::string text);
  [[nodiscard]] bool has(std::string_view kind, std::string_view text) const;
  /// Its first word of a kind; empty: it has none.
  [[nodiscard]] std::string word(std::string_view kind) const;
};
/// "iio:device0 (name `mcp4725`, address `1-0060`)"
[[nodiscard]] std::string text_of(const ComputerDevice& device);

/// Returns the device behind an entry of a bus in sysfs (/sys/bus/iio/devices/iio:device0) with its address
/// on its bus (1-0060, spi0.1) and the serial number of the USB device that it is part of. An entry that is
/// no symbolic link has neither.
[[nodiscard]] ComputerDevice device_at(const std::filesystem::path& entry);
/// Returns the devices behind all entries whose name begins with `prefix`, in the order of their names.
[[nodiscard]] std::vector<ComputerDevice> devices_in(const std::filesystem::path& bus,
                                                     std::string_view prefix);
/// Returns the first line of a file without the blanks at its end; empty if there is none.
[[nodiscard]] std::string first_line(const std::filesystem::path& file);

/// Why a word means no device.
struct UnclearDevice {
  bool several = false;  ///< false: it fits none
  std::string message;   ///< with all devices that it fits
  std::string hint;      ///< what to write instead
};

/// Returns the only device that `word` fits: its node, one of its words, or the path of a folder in sysfs in
/// which it is. `kind`: "converter", "GPIO chip", "serial device", for the messages.
[[nodiscard]] tl::expected<ComputerDevice, UnclearDevice> only_device(
    const std::vector<ComputerDevice>& devices, const std::string& word, std::string_view kind);
/// Returns the refusal of a word that fits all of `found`, of which `devices` are all there are.
[[nodiscard]] UnclearDevice several_devices(const std::vector<ComputerDevice>& devices,
                                            const std::vector<ComputerDevice>& found, const std::string& word,
                                            std::string_view kind);

}  // namespace softgrip
