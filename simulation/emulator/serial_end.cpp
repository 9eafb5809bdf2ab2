#include "simulation/emulator/serial_end.h"

#include <fcntl.h>
#include <modbus/modbus.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "base/time.h"
#include "drivers/modbus/serial_port.h"

namespace softgrip::simulation {
namespace {

tl::unexpected<std::string> failure(const std::string& what, int error) {
  return tl::unexpected{what + ": " + std::strerror(error)};
}

bool is_pseudo_terminal(const std::string& device) {
  std::array<char, 4096> real{};
  return ::realpath(device.c_str(), real.data()) != nullptr && std::strncmp(real.data(), "/dev/pts/", 9) == 0;
}

}  // namespace

SerialEnd::SerialEnd(SerialEnd&& other) noexcept
    : line_(std::move(other.line_)),
      end_(std::move(other.end_)),
      kept_(std::move(other.kept_)),
      link_(std::exchange(other.link_, {})),
      pseudo_(other.pseudo_) {}

SerialEnd& SerialEnd::operator=(SerialEnd&& other) noexcept {
  std::swap(line_, other.line_);
  end_ = std::move(other.end_);
  kept_ = std::move(other.kept_);
  std::swap(link_, other.link_);
  pseudo_ = other.pseudo_;
  return *this;
}

SerialEnd::~SerialEnd() {
  if (!link_.empty()) ::unlink(link_.c_str());
}

tl::expected<void, std::string> SerialEnd::make_pseudo() {
  end_ = Descriptor{::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)};
  std::array<char, 128> name{};
  if (!end_ || ::grantpt(end_.get()) != 0 || ::unlockpt(end_.get()) != 0 ||
      ::ptsname_r(end_.get(), name.data(), name.size()) != 0) {
    return failure("a pseudo-terminal", errno);
  }
  kept_ = Descriptor{::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC)};
  termios raw{};
  if (!kept_ || ::tcgetattr(kept_.get(), &raw) != 0) return failure(name.data(), errno);
  ::cfmakeraw(&raw);
  if (::tcsetattr(kept_.get(), TCSANOW, &raw) != 0) return failure(name.data(), errno);
  if (::symlink(name.data(), line_.device.c_str()) != 0) return failure(line_.device, errno);
  link_ = line_.device;
  pseudo_ = true;
  return {};
}

tl::expected<void, std::string> SerialEnd::open_device() {
  modbus_t* const context = drivers::new_context(line_);
  const drivers::SerialFailure failed = drivers::open_serial(context, line_, kept_);
  end_ = Descriptor{::modbus_get_socket(context)};
  ::modbus_free(context);  // modbus_free() does not close the descriptor
  if (failed.what != nullptr) return failure(std::string(failed.what) + " " + line_.device, failed.error);
  pseudo_ = is_pseudo_terminal(line_.device);
  return {};
}

tl::expected<SerialEnd, std::string> SerialEnd::open(const drivers::SerialLine& line) {
  SerialEnd end(line);
  struct stat about {};
  if (::stat(line.device.c_str(), &about) != 0 && errno == ENOENT) {
    // A link whose target does not exist is removed, because an emulator that was killed leaves such a link.
    if (::lstat(line.device.c_str(), &about) == 0 && S_ISLNK(about.st_mode)) ::unlink(line.device.c_str());
    if (auto made = end.make_pseudo(); !made) return tl::unexpected{made.error()};
    return end;
  }
  if (auto opened = end.open_device(); !opened) return tl::unexpected{opened.error()};
  return end;
}

WireTime SerialEnd::wire_time() const noexcept {
  WireTime time;
  time.turnaround = std::chrono::nanoseconds{nanoseconds(line_.turnaround_s)};
  if (!pseudo_) return time;
  time.character = std::chrono::nanoseconds{nanoseconds(drivers::character_s(line_))};
  time.silence = std::chrono::nanoseconds{nanoseconds(drivers::silence_s(line_))};
  return time;
}

}  // namespace softgrip::simulation
