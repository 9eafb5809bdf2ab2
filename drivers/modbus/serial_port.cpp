#include "drivers/modbus/serial_port.h"

#include <asm/termbits.h>  // defines struct termios2; <termios.h> cannot be included together with this

#include <algorithm>

// header
#include <fcntl.h>
#include <modbus/modbus.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <fstream>

namespace softgrip::drivers {
namespace {

// Silence between two frames in MODBUS over Serial Line V1.02, 2.5.1.1: 3.5 characters, or a fixed time above
// 19200 baud.
constexpr double silent_characters = 3.5;
constexpr double fixed_silence_s = 1.75e-3;
constexpr std::uint32_t fixed_above_baud = 19200;

bool is_pseudo_terminal(int descriptor) noexcept {
  // Major device numbers of Unix98 pseudo-terminals (Documentation/admin-guide/devices.txt of the kernel).
  constexpr unsigned first_slave_major = 136;
  constexpr unsigned last_slave_major = 143;
  struct stat about {};
  if (::fstat(descriptor, &about) != 0) return false;
  const unsigned number = major(about.st_rdev);
  return number >= first_slave_major && number <= last_slave_major;
}

tcflag_t line_flags(const SerialLine& line) noexcept {
  tcflag_t flags = CS8;
  if (line.parity != Parity::none) flags |= PARENB;
  if (line.parity == Parity::odd) flags |= PARODD;
  if (line.stop_bits > 1) flags |= CSTOPB;
  return flags;
}

/// Returns true if the settings of the device contain the baud rate and the format of `line`.
bool keeps_to(int descriptor, const SerialLine& line) noexcept {
  termios2 settings{};  // struct in which the baud rate is a number
  if (::ioctl(descriptor, TCGETS2, &settings) != 0) return false;
  constexpr tcflag_t judged = CSIZE | PARENB | PARODD | CSTOPB;
  const bool same_format = (settings.c_cflag & judged) == line_flags(line);
  return settings.c_ospeed == line.baud && (same_format || is_pseudo_terminal(descriptor));
}

char parity_of(const SerialLine& line) noexcept {
  return line.parity == Parity::none ? 'N' : line.parity == Parity::even ? 'E' : 'O';
}

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

modbus_t* new_context(const SerialLine& line) {
  return ::modbus_new_rtu(line.device.c_str(), static_cast<int>(line.baud), parity_of(line), 8,
                          line.stop_bits);
}

SerialFailure open_serial(modbus_t* context, const SerialLine& line, Descriptor& master) noexcept {
  master = Descriptor(::open(line.device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!master) return {"opening the serial device", errno};
  if (::isatty(master.get()) == 0) return {"opening the serial device", ENOTTY};
  if (::flock(master.get(), LOCK_EX | LOCK_NB) != 0) return {"locking the serial device", EBUSY};
  if (::modbus_connect(context) != 0) return {"setting the serial line", errno};
  if (!keeps_to(::modbus_get_socket(context), line)) {
    return {"setting the serial line: the device does not apply the baud rate or the format", 0};
  }
  (void)::modbus_flush(context);
  return {};
}

double character_s(const SerialLine& line) noexcept {
  constexpr int start_and_data_bits = 9;
  const int bits = start_and_data_bits + (line.parity == Parity::none ? 0 : 1) + line.stop_bits;
  return bits / static_cast<double>(line.baud);
}

double silence_s(const SerialLine& line) noexcept {
  const double by_specification =
      line.baud > fixed_above_baud ? fixed_silence_s : silent_characters * character_s(line);
  return line.silence_s.value_or(by_specification);
}

std::span<const std::string_view> formats() noexcept {
  static constexpr std::array<std::string_view, 5> texts{"8N1", "8E1", "8O1", "8N2", "8E2"};
  return texts;
}

bool set_format(std::string_view text, SerialLine& line) noexcept {
  const auto known = formats();
  if (std::find(known.begin(), known.end(), text) == known.end()) return false;
  line.parity = text[1] == 'N' ? Parity::none : text[1] == 'E' ? Parity::even : Parity::odd;
  line.stop_bits = text[2] - '0';
  return true;
}

std::string format_of(const SerialLine& line) {
  return std::to_string(line.baud) + " 8" + parity_of(line) + std::to_string(line.stop_bits);
}

std::optional<AdapterLatency> adapter_latency(const std::string& device, const std::string& sys) {
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(device, error);
  if (error) return std::nullopt;
  const std::string path = sys + "/class/tty/" + real.filename().string() + "/device/latency_timer";
  int milliseconds = -1;
  std::ifstream(path) >> milliseconds;
  if (milliseconds < 0) return std::nullopt;
  return AdapterLatency{milliseconds * 1e-3, path};
}

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
