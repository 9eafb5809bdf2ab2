#pragma once
// One attribute of an industrial I/O device: a text file through which the kernel accesses the device.

#include <optional>
#include <string>

namespace softgrip::drivers {

/// An attribute that stays open. Each read() or write() therefore needs one system call, and does not
/// allocate.
class IioAttribute {
 public:
  IioAttribute() = default;
  IioAttribute(const IioAttribute&) = delete;
  IioAttribute& operator=(const IioAttribute&) = delete;
  IioAttribute(IioAttribute&& other) noexcept;
  IioAttribute& operator=(IioAttribute&& other) noexcept;
  ~IioAttribute();

  /// Opens the attribute for reading or for writing. Returns errno, or 0.
  [[nodiscard]] int open(const std::string& path, bool writable) noexcept;
  void close() noexcept;
  [[nodiscard]] bool is_open() const noexcept { return descriptor_ >= 0; }

  /// Returns the present number; nothing after an error. In that case errno is the reason, or 0 if the text
  /// of the attribute is not a number.
  [[nodiscard]] std::optional<double> read() const noexcept;
  /// Writes a whole number. Returns errno, or 0.
  [[nodiscard]] int write(long value) const noexcept;

 private:
  int descriptor_ = -1;
};

}  // namespace softgrip::drivers
