#pragma once
// Accesses one attribute of an industrial I/O device. An attribute is a text file through which the kernel
// gives access to the device.

#include <optional>
#include <string>

namespace softgrip::drivers {

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

}  // namespace softgrip::drivers
