#pragma once
// Defines what gpio_libgpiod.cpp needs from every version of libgpiod. gpio_libgpiod.cpp includes
// libgpiod_1.h or libgpiod_2.h, depending on the version of the installed library.

#include <gpiod.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "base/time.h"

namespace softgrip::drivers::libgpiod {

inline constexpr const char* consumer = "softgripd";
/// Largest number of edges that one call reads from a line. The kernel stores up to 16 edges per line.
inline constexpr std::size_t edges_at_once = 16;
inline constexpr Nanoseconds ns_per_s = 1'000'000'000;

/// The information that the kernel gives about a line.
struct LineFacts {
  std::uint32_t offset = 0;
  bool used = false;
  bool output = false;
  std::string consumer;
  std::string name;
};

struct CloseChip {
  void operator()(gpiod_chip* chip) const noexcept { gpiod_chip_close(chip); }
};
/// A handle of a GPIO chip. The chip is closed when the handle is destroyed.
using Chip = std::unique_ptr<gpiod_chip, CloseChip>;

}  // namespace softgrip::drivers::libgpiod
