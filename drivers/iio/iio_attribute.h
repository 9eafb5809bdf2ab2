#pragma once
// One attribute of an industrial I/O device: a small text file that is the device itself.

#include <optional>
#include <string>

namespace softgrip::drivers {

/// Keeps its descriptor open: reading and writing is one system call each, and allocates nothing.
class IioAttribute {
 public:
  IioAttribute() = default;
  IioAttribute(const IioAttribute&) = delete;
  IioAttribute& operator=(const IioAttribute&) = delete;
  IioAttribute(IioAttribute&& other) noexcept;
  IioAttribute& operator=(IioAttribute&& other) noexcept;
  ~IioAttribute();

  /// Opens it for reading or for writing; errno, or 0.
  [[nodiscard]] int open(const std::string& path, bool writable) noexcept;
  void close() noexcept;
  [[nodiscard]] bool is_open() const noexcept { return descriptor_ >= 0; }

  /// The number that it holds now. Nothing: errno says why, 0 if the text is no number.
  [[nodiscard]] std::optional<double> read() const noexcept;
  /// Writes a whole number; errno, or 0.
  [[nodiscard]] int write(long value) const noexcept;

 private:
  int descriptor_ = -1;
};

}  // namespace softgrip::drivers
