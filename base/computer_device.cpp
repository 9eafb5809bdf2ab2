#include "base/computer_device.h"

#include <algorithm>
#include <fstream>

#include "base/text.h"

namespace softgrip {

namespace {

namespace fs = std::filesystem;

std::string in_backticks(const std::string& text) {
  return "`" + text + "`";
}

/// Returns the serial number of the USB device to which a folder in sysfs belongs. The search upwards in the
/// path ends at this USB device, because a USB hub higher in the path has a serial number of its own.
std::string usb_serial_number(fs::path folder) {
  std::error_code error;
  for (; folder.has_relative_path(); folder = folder.parent_path()) {
    if (fs::exists(folder / "idVendor", error)) return first_line(folder / "serial");
  }
  return {};
}

bool is_inside(const fs::path& device, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), device.begin(), device.end()).first == folder.end();
}

bool fits(const ComputerDevice& device, const std::string& word) {
  if (word.empty()) return false;
  const auto is_it = [&](const DeviceWord& known) { return known.text == word; };
  if (device.node == word || std::any_of(device.words.begin(), device.words.end(), is_it)) return true;
  if (word.front() != '/' || device.folder.empty()) return false;
  std::error_code error;
  const fs::path folder = fs::canonical(word, error);
  return !error && is_inside(device.folder, folder);
}

std::vector<ComputerDevice> fitting(const std::vector<ComputerDevice>& devices, const std::string& word) {
  std::vector<ComputerDevice> found;
  std::copy_if(devices.begin(), devices.end(), std::back_inserter(found),
               [&](const ComputerDevice& device) { return fits(device, word); });
  return found;
}

/// Returns the first word of `device` that no other device in `devices` has; empty if `device` has no word of
/// its own.
std::string own_word(const std::vector<ComputerDevice>& devices, const ComputerDevice& device) {
  for (const DeviceWord& word : device.words) {
    if (fitting(devices, word.text).size() == 1) return word.text;
  }
  return {};
}

}  // namespace

void ComputerDevice::add(std::string_view kind, std::string text) {
  if (!text.empty()) words.push_back({std::string(kind), std::move(text)});
}

bool ComputerDevice::has(std::string_view kind, std::string_view text) const {
  return std::any_of(words.begin(), words.end(),
                     [&](const DeviceWord& word) { return word.kind == kind && word.text == text; });
}

std::string ComputerDevice::word(std::string_view kind) const {
  const auto found =
      std::find_if(words.begin(), words.end(), [&](const DeviceWord& known) { return known.kind == kind; });
  return found != words.end() ? found->text : std::string{};
}

std::string text_of(const ComputerDevice& device) {
  if (device.words.empty()) return device.node;
  return device.node + " (" +
         with_commas(device.words,
                     [](const DeviceWord& word) { return word.kind + " " + in_backticks(word.text); }) +
         ")";
}

std::string first_line(const fs::path& file) {
  std::string line;
  std::ifstream stream(file);
  std::getline(stream, line);
  line.erase(line.find_last_not_of(" \t\r") + 1);
  return line;
}

ComputerDevice device_at(const fs::path& entry) {
  ComputerDevice device;
  device.node = entry.filename().string();
  std::error_code error;
  device.folder = fs::canonical(entry, error);
  if (!error && fs::is_symlink(entry, error)) {
    device.add("serial number", usb_serial_number(device.folder));
    device.add("address", device.folder.parent_path().filename().string());
  }
  return device;
}

std::vector<ComputerDevice> devices_in(const fs::path& bus, std::string_view prefix) {
  std::vector<fs::path> entries;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(bus, error)) {
    if (entry.path().filename().string().starts_with(prefix)) entries.push_back(entry.path());
  }
  std::sort(entries.begin(), entries.end());
  std::vector<ComputerDevice> devices;
  std::transform(entries.begin(), entries.end(), std::back_inserter(devices), device_at);
  return devices;
}

tl::expected<ComputerDevice, UnclearDevice> only_device(const std::vector<ComputerDevice>& devices,
                                                        const std::string& word, std::string_view kind) {
  std::vector<ComputerDevice> found = fitting(devices, word);
  if (found.size() == 1) return std::move(found.front());
  if (found.size() > 1) return tl::unexpected(several_devices(devices, found, word, kind));
  const std::string what = "no " + std::string(kind);
  return tl::unexpected(UnclearDevice{
      false, what + " of this computer is called " + in_backticks(word),
      devices.empty()
          ? what + " is there"
          : (devices.size() == 1 ? "there is " : "there are ") +
                enumerated(devices, " and ", [](const ComputerDevice& device) { return text_of(device); })});
}

UnclearDevice several_devices(const std::vector<ComputerDevice>& devices,
                              const std::vector<ComputerDevice>& found, const std::string& word,
                              std::string_view kind) {
  std::vector<std::string> instead;
  bool stays = true;
  for (const ComputerDevice& device : found) {
    const std::string own = own_word(devices, device);
    stays = stays && !own.empty();
    instead.push_back(in_backticks(own.empty() ? device.node : own));
  }
  return {true,
          in_backticks(word) + " fits " + std::to_string(found.size()) + " " + std::string(kind) + "s: " +
              enumerated(found, " and ", [](const ComputerDevice& device) { return text_of(device); }),
          "write " + enumerated(instead, " or ") +
              (stays ? "" : "; the kernel may assign other device numbers after a reboot")};
}

}  // namespace softgrip
