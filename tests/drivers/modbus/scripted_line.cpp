#include "tests/drivers/modbus/scripted_line.h"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <stdexcept>
#include <utility>

namespace softgrip::drivers::test {
namespace {

constexpr int quiet_ms = 3;
constexpr int look_ms = 20;

}  // namespace

Bytes checked(Bytes bytes) {
  // Compute the checksum bit by bit, because the driver uses a table. Two different algorithms do not contain
  // the same error.
  std::uint32_t crc = 0xffff;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int i = 0; i < 8; ++i) {
      const bool carry = crc % 2 == 1;
      crc /= 2;
      if (carry) crc ^= 0xa001;
    }
  }
  bytes.push_back(static_cast<std::uint8_t>(crc % 256));
  bytes.push_back(static_cast<std::uint8_t>(crc / 256));
  return bytes;
}

ScriptedLine::ScriptedLine(Handler handler, std::string name)
    : handler_(std::move(handler)), name_(std::move(name)) {
  std::array<char, 128> device{};
  if (::openpty(&master_, &kept_, device.data(), nullptr, nullptr) != 0) throw std::runtime_error("openpty");
  termios raw{};
  ::tcgetattr(kept_, &raw);
  ::cfmakeraw(&raw);
  ::tcsetattr(kept_, TCSANOW, &raw);
  device_ = device.data();
  if (!name_.empty()) {
    ::unlink(name_.c_str());
    if (::symlink(device_.c_str(), name_.c_str()) != 0) throw std::runtime_error("symlink");
  }
  thread_ = std::thread([this] { serve(); });
}

ScriptedLine::~ScriptedLine() {
  stopping_ = true;
  thread_.join();
  if (!name_.empty()) ::unlink(name_.c_str());
  ::close(kept_);
  ::close(master_);
}

void ScriptedLine::send(const Bytes& bytes) {
  if (::write(master_, bytes.data(), bytes.size()) < 0) stopping_ = true;
}

void ScriptedLine::drip(const Bytes& bytes, std::chrono::milliseconds pause) {
  for (const std::uint8_t byte : bytes) {
    if (stopping_) return;
    send({byte});
    wait(pause);
  }
}

void ScriptedLine::serve() {
  std::size_t index = 0;
  Bytes request;
  while (!stopping_) {
    pollfd waiting{master_, POLLIN, 0};
    const int ready = ::poll(&waiting, 1, request.empty() ? look_ms : quiet_ms);
    if (ready == 0 && !request.empty()) {
      handler_(*this, std::exchange(request, {}), index++);
    } else if (ready > 0) {
      std::array<std::uint8_t, 512> buffer{};
      const ssize_t count = ::read(master_, buffer.data(), buffer.size());
      if (count <= 0) continue;
      request.insert(request.end(), buffer.begin(), buffer.begin() + count);
    }
  }
}

}  // namespace softgrip::drivers::test
