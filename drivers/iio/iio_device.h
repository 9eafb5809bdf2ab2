#pragma once
// Finds the A/D and D/A converters of this computer.
// Accesses one attribute of an industrial I/O device. An attribute is a text file through which the kernel
// gives access to the device.
// Reads the scale and the offset of a converter's channel from its attributes.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/computer_device.h"

namespace softgrip::drivers {

/// Returns the converters in the folder `root` (/sys/bus/iio/devices). The words of a converter are the names
/// by which a rig file can select it. These are its attributes `label`, `name` and `serialnumber`, its
/// address on its bus, and the serial number of its USB device, as far as they exist.
[[nodiscard]] std::vector<ComputerDevice> converters_in(const std::filesystem::path& root);

/// Returns the properties of a converter that stay the same when its name in the kernel changes: its `name`
/// and its position on its bus, for example "mcp4725 at /sys/devices/platform/soc/fe804000.i2c/i2c-1/1-0060".
/// If the converter has no bus address, returns only its `name`.
[[nodiscard]] std::string identity_of(const ComputerDevice& converter);

/// Returns the type of a channel, for example "voltage" for "voltage0".
[[nodiscard]] std::string type_of(const std::string& channel);
/// Returns the name of the attribute that switches off the output `channel`. The attribute belongs to this
/// output alone, or to all outputs of its type. Returns an empty text if the converter in `folder` has no
/// such attribute.
[[nodiscard]] std::string powerdown_of(const std::filesystem::path& folder, const std::string& channel);

/// Keeps the file of an attribute open. Therefore, each read() or write() needs only one system call and
/// allocates no memory.
class IioAttribute {
 public:
  IioAttribute() = default;
  IioAttribute(const IioAttribute&) = delete;
  IioAttribute& operator=(const IioAttribute&) = delete;
  IioAttribute(IioAttribute&& other) noexcept;
  IioAttribute& operator=(IioAttribute&& other) noexcept;
  ~IioAttribute();

  /// Opens the attribute for writing if `writable` is true, otherwise for reading. Returns 0 on success, and
  /// errno after a failure.
  [[nodiscard]] int open(const std::string& path, bool writable) noexcept;
  void close() noexcept;
  [[nodiscard]] bool is_open() const noexcept { return descriptor_ >= 0; }

  /// Returns the present number of the attribute, or nothing after an error. After an error, errno contains
  /// the reason; errno is 0 if the text of the attribute is not a number.
  [[nodiscard]] std::optional<double> read() const noexcept;
  /// Writes a whole number to the attribute. Returns 0 on success, and errno after a failure.
  [[nodiscard]] int write(long value) const noexcept;

 private:
  int descriptor_ = -1;
};

/// The value of a channel in V, mA or kPa is (raw + offset) * scale.
struct IioScaling {
  double scale = 1;   ///< factor from the raw number to V, mA or kPa; 0: the converter has no scale
  double offset = 0;  ///< number that is added to the raw number
};

/// Reads the scaling of a channel's raw number. For a channel without attributes of its own, reads the
/// attributes that all channels of this type share.
[[nodiscard]] IioScaling scaling_of(const std::filesystem::path& folder, const std::string& channel,
                                    bool output);

/// Returns the scaling of a channel whose attribute contains the number in mV, mA or kPa.
[[nodiscard]] IioScaling scaling_of_processed(const std::string& channel) noexcept;

}  // namespace softgrip::drivers
