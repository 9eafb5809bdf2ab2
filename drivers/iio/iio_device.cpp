#include "drivers/iio/iio_device.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <string_view>
#include <utility>

#include "drivers/iio/iio_settings.h"

namespace softgrip::drivers {
namespace {

// Space for the text of a number [bytes], including the line break that some drivers append to the number.
constexpr std::size_t longest_text = 64;

/// Returns the factor from the unit of the kernel to V, mA or kPa. The kernel gives voltages in mV, currents
/// in mA and pressures in kPa.
double per_unit(std::string_view channel) noexcept {
  return unit_of_channel(channel) == ElectricalUnit::volt ? 1e-3 : 1;
}

/// Returns the number in the attribute `what` of one channel. If this channel has no such attribute, returns
/// the number in the attribute `what` that all channels of this type share. If neither attribute exists,
/// returns `otherwise`.
double shared_number(const std::filesystem::path& folder, const std::string& direction,
                     const std::string& channel, const std::string& what, double otherwise) {
  for (const std::string& whose : {channel, type_of(channel)}) {
    IioAttribute attribute;
    if (attribute.open((folder / (direction + whose + what)).string(), false) != 0) continue;
    if (const auto value = attribute.read()) return *value;
  }
  return otherwise;
}

}  // namespace

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

IioAttribute::IioAttribute(IioAttribute&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

IioAttribute& IioAttribute::operator=(IioAttribute&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

IioAttribute::~IioAttribute() {
  close();
}

void IioAttribute::close() noexcept {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

int IioAttribute::open(const std::string& path, bool writable) noexcept {
  close();
  descriptor_ = ::open(path.c_str(), (writable ? O_WRONLY : O_RDONLY) | O_CLOEXEC);
  return descriptor_ >= 0 ? 0 : errno;
}

std::optional<double> IioAttribute::read() const noexcept {
  std::array<char, longest_text> text{};
  // sysfs gets a new value from the driver only if the file is read at offset 0.
  const ssize_t count = ::pread(descriptor_, text.data(), text.size(), 0);
  if (count < 0) return std::nullopt;
  double value = 0;
  const char* const end = text.data() + count;
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || (rest != end && *rest != '\n')) {
    errno = 0;
    return std::nullopt;
  }
  return value;
}

int IioAttribute::write(long value) const noexcept {
  std::array<char, longest_text> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size() - 1, value);
  if (error != std::errc{}) return EINVAL;
  *end = '\n';
  const auto size = static_cast<std::size_t>(end + 1 - text.data());
  const ssize_t count = ::pwrite(descriptor_, text.data(), size, 0);
  if (count < 0) return errno;
  return static_cast<std::size_t>(count) == size ? 0 : EIO;
}

IioScaling scaling_of(const std::filesystem::path& folder, const std::string& channel, bool output) {
  const std::string direction = output ? "out_" : "in_";
  const double scale = shared_number(folder, direction, channel, "_scale", 0);
  return {scale * per_unit(channel), shared_number(folder, direction, channel, "_offset", 0)};
}

IioScaling scaling_of_processed(const std::string& channel) noexcept {
  return {per_unit(channel), 0};
}

}  // namespace softgrip::drivers
