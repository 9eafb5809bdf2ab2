#include "drivers/modbus/serial_port.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <utility>

namespace softgrip::drivers {
namespace {

// MODBUS over Serial Line V1.02, 2.5.1.1: 3.5 characters, and above 19200 baud a fixed time.
constexpr double silent_characters = 3.5;
constexpr double fixed_silence_s = 1.75e-3;
constexpr std::uint32_t fixed_above_baud = 19200;

constexpr std::array<std::pair<std::uint32_t, speed_t>, 12> speeds{{{1200, B1200},
                                                                    {2400, B2400},
                                                                    {4800, B4800},
                                                                    {9600, B9600},
                                                                    {19200, B19200},
                                                                    {38400, B38400},
                                                                    {57600, B57600},
                                                                    {115200, B115200},
                                                                    {230400, B230400},
                                                                    {460800, B460800},
                                                                    {921600, B921600},
                                                                    {1000000, B1000000}}};

speed_t speed_of(std::uint32_t baud) noexcept {
  const auto* const found =
      std::find_if(speeds.begin(), speeds.end(), [baud](const auto& pair) { return pair.first == baud; });
  return found == speeds.end() ? B0 : found->second;
}

bool is_pseudo_terminal(int descriptor) noexcept {
  // Documentation/admin-guide/devices.txt of the kernel: Unix98 slaves.
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

constexpr tcflag_t judged_flags = CSIZE | PARENB | PARODD | CSTOPB;

/// Bytes as they are, no modem lines, no signals.
bool configure(int descriptor, const SerialLine& line) noexcept {
  termios settings{};
  if (::tcgetattr(descriptor, &settings) != 0) return false;
  ::cfmakeraw(&settings);
  settings.c_cflag &= ~(judged_flags | CRTSCTS | HUPCL);
  settings.c_cflag |= line_flags(line) | CLOCAL | CREAD;
  settings.c_iflag &= ~static_cast<tcflag_t>(IXON | IXOFF | IXANY | INPCK);
  settings.c_cc[VMIN] = 1;  // with O_NONBLOCK: no byte is EAGAIN, and 0 is the end of the line
  settings.c_cc[VTIME] = 0;
  return ::cfsetspeed(&settings, speed_of(line.baud)) == 0 &&
         ::tcsetattr(descriptor, TCSANOW, &settings) == 0;
}

/// tcsetattr succeeds if any of the settings was taken.
bool keeps_to(int descriptor, const SerialLine& line) noexcept {
  termios settings{};
  if (::tcgetattr(descriptor, &settings) != 0) return false;
  const bool same_speed = ::cfgetospeed(&settings) == speed_of(line.baud);
  const bool same_format = (settings.c_cflag & judged_flags) == line_flags(line);
  return same_speed && (same_format || is_pseudo_terminal(descriptor));
}

SerialPort failed(int descriptor, const char* what, int error) noexcept {
  if (descriptor >= 0) ::close(descriptor);
  return {-1, what, error};
}

}  // namespace

SerialPort open_serial(const SerialLine& line) noexcept {
  const int descriptor = ::open(line.device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return failed(-1, "opening the serial device", errno);
  if (::isatty(descriptor) == 0) return failed(descriptor, "opening the serial device", ENOTTY);
  // Two masters on one line would take each other's answers.
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0)
    return failed(descriptor, "taking the serial device", EBUSY);
  if (!configure(descriptor, line)) return failed(descriptor, "setting the serial line", errno);
  if (!keeps_to(descriptor, line)) {
    return failed(descriptor, "setting the serial line: the device does not keep to rate or format", 0);
  }
  (void)::tcflush(descriptor, TCIOFLUSH);
  return {descriptor, "", 0};
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
  const char parity = line.parity == Parity::none ? 'N' : line.parity == Parity::even ? 'E' : 'O';
  return std::to_string(line.baud) + " 8" + parity + std::to_string(line.stop_bits);
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

}  // namespace softgrip::drivers
