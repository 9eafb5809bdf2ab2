#include "drivers/iio/iio_attribute.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <utility>

namespace softgrip::drivers {
namespace {

// Space for the text of a number [bytes], including the line break that some drivers append to the number.
constexpr std::size_t longest_text = 64;

}  // namespace

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

}  // namespace softgrip::drivers
