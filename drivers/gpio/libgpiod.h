#pragma once
// What both APIs of libgpiod give of a chip and a line, under different names: common to libgpiod_1.h and
// libgpiod_2.h, of which gpio_libgpiod.cpp includes the one that fits the installed library.

#include <gpiod.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "base/time.h"

namespace softgrip::drivers::libgpiod {

inline constexpr const char* consumer = "softgripd";
/// Edges taken from one line at once; the kernel keeps 16 per line.
inline constexpr std::size_t edges_at_once = 16;
inline constexpr Nanoseconds ns_per_s = 1'000'000'000;

/// What the kernel knows of a line.
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
/// Open as long as its handle lives.
using Chip = std::unique_ptr<gpiod_chip, CloseChip>;

}  // namespace softgrip::drivers::libgpiod
