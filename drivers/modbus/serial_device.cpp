#include "drivers/modbus/serial_device.h"

#include <algorithm>

namespace softgrip::drivers {

namespace {

namespace fs = std::filesystem;

constexpr const char* serial_device = "serial device";

/// Returns the names of the files in the folder `folder` of `root`, in alphabetical order. Names that begin
/// with a dot are left out.
std::vector<std::string> names_in(const fs::path& root, const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(root / folder, error)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(".")) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Returns the name of the folder that udev creates in /run/udev/links for the link `link`. The function
/// udev_node_escape_path() of systemd forms the name in this way.
std::string escaped(const std::string& link) {
  std::string text;
  for (const char c : link) {
    if (c == '/') {
      text += "\\x2f";
    } else if (c == '\\') {
      text += "\\x5c";
    } else {
      text += c;
    }
  }
  return text;
}

/// Returns the device with the file `node`. The words of the device are the names of its port (links in
/// /dev/serial/by-path).
ComputerDevice on_port(const fs::path& root, const std::string& node) {
  ComputerDevice device{node, {}, {}};
  std::error_code error;
  const std::string ports = "dev/serial/by-path";
  for (const std::string& port : names_in(root, ports)) {
    if (fs::equivalent(root / ports / port, root / fs::path(node).relative_path(), error))
      device.add("port", "/" + ports + "/" + port);
  }
  return device;
}

/// Returns the devices to which udev gave the link `link`. udev has a folder for each link. In this folder,
/// each device has an entry such as "c188:0", which leads to "PRIORITY:/dev/ttyUSB0".
std::vector<ComputerDevice> claimants(const fs::path& root, const std::string& link) {
  const std::string folder = "run/udev/links/" + escaped(link);
  std::vector<ComputerDevice> found;
  for (const std::string& entry : names_in(root, folder)) {
    std::error_code error;
    const std::string target = fs::read_symlink(root / folder / entry, error).string();
    const std::string node = target.substr(std::min(target.find(':') + 1, target.size()));
    const bool is_there = !error && fs::exists(root / fs::path(node).relative_path(), error);
    if (is_there) found.push_back(on_port(root, node));
  }
  return found;
}

std::vector<ComputerDevice> adapters(const fs::path& root) {
  std::vector<ComputerDevice> found;
  for (const std::string& name : names_in(root, "dev/serial/by-id"))
    found.push_back({"/dev/serial/by-id/" + name, {}, {}});
  return found;
}

}  // namespace

std::optional<UnclearDevice> unclear_serial_device(const std::string& path, const fs::path& root) {
  constexpr std::string_view devices = "/dev/";
  const std::string name = fs::path(path).lexically_normal().string();
  if (!name.starts_with(devices)) return std::nullopt;
  std::error_code error;
  if (!fs::exists(root / fs::path(name).relative_path(), error))
    return only_device(adapters(root), path, serial_device).error();
  const std::vector<ComputerDevice> found = claimants(root, name.substr(devices.size()));
  if (found.size() < 2) return std::nullopt;
  return several_devices(found, found, path, serial_device);
}

}  // namespace softgrip::drivers
