#pragma once
// Finds the device of this computer that a configuration file names. Converters, GPIO chips and serial
// adapters are found by one rule.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

namespace softgrip {

/// A word by which a configuration file can name a device.
struct DeviceWord {
  std::string kind;  ///< kind of the word, such as "label", "name", "serial number" or "address"
  std::string text;
};

struct ComputerDevice {
  std::string node;               ///< name in the kernel, such as iio:device0, which may change at every
                                  ///< start of the computer
  std::filesystem::path folder;   ///< folder of the device in sysfs, without symbolic links; empty: the
                                  ///< folder is unknown
  std::vector<DeviceWord> words;  ///< words that stay the same when the name in the kernel changes

  /// Adds a word if `text` is not empty.
  void add(std::string_view kind, std::string text);
  [[nodiscard]] bool has(std::string_view kind, std::string_view text) const;
  /// Returns the first word of this kind that the device has; empty if the device has no word of this kind.
  [[nodiscard]] std::string word(std::string_view kind) const;
};
/// Returns a description of the device, for example "iio:device0 (name `mcp4725`, address `1-0060`)".
[[nodiscard]] std::string text_of(const ComputerDevice& device);

/// Returns the device for an entry of a bus folder in sysfs (/sys/bus/iio/devices/iio:device0). The words of
/// the device are its address on the bus (1-0060, spi0.1) and the serial number of its USB device. The result
/// has no words if the entry is not a symbolic link.
[[nodiscard]] ComputerDevice device_at(const std::filesystem::path& entry);
/// Returns the devices for those entries of a bus folder whose names begin with `prefix`, in alphabetical
/// order.
[[nodiscard]] std::vector<ComputerDevice> devices_in(const std::filesystem::path& bus,
                                                     std::string_view prefix);
/// Returns the first line of a file without trailing white space; empty if the file has no line or cannot be
/// read.
[[nodiscard]] std::string first_line(const std::filesystem::path& file);

/// The reason why a word in a file does not identify exactly one device.
struct UnclearDevice {
  bool several = false;  ///< true: the word matches several devices; false: the word matches no device
  std::string message;   ///< message that lists all devices that match the word
  std::string hint;      ///< a word of one device that the user can write in place of the unclear word
};

/// Returns the device that `word` matches, if `word` matches exactly one device. A word matches the node of a
/// device, one of its words, or the path of a sysfs folder that contains the device. `kind` is the name of
/// the device type in messages: "converter", "GPIO chip", "serial device".
[[nodiscard]] tl::expected<ComputerDevice, UnclearDevice> only_device(
    const std::vector<ComputerDevice>& devices, const std::string& word, std::string_view kind);
/// Returns the error for a word that several devices match. `found` contains the devices that match, and
/// `devices` contains all devices.
[[nodiscard]] UnclearDevice several_devices(const std::vector<ComputerDevice>& devices,
                                            const std::vector<ComputerDevice>& found, const std::string& word,
                                            std::string_view kind);

}  // namespace softgrip
