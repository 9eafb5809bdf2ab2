#pragma once
// The terminal that a live view owns for a while, and gives back as it was.

#include <termios.h>

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "base/descriptor.h"

namespace softgrip::tools {

/// True if the standard output is a terminal that moves its cursor.
[[nodiscard]] bool on_terminal();
/// True unless NO_COLOR is set (https://no-color.org) or the output is no terminal.
[[nodiscard]] bool wants_colour();
/// True if the locale's character encoding is UTF-8.
[[nodiscard]] bool has_unicode();
/// Columns of the standard output, or 80.
[[nodiscard]] std::size_t terminal_columns();

/// Takes SIGINT, SIGTERM, SIGHUP and SIGWINCH as a descriptor in place of their usual effect.
[[nodiscard]] Descriptor take_ending_signals();

/// Full-screen drawing. The screen, the cursor and the keyboard are restored when it is destroyed.
class Screen {
 public:
  Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;
  Screen(Screen&&) = delete;
  Screen& operator=(Screen&&) = delete;
  ~Screen();

  /// Replaces what is shown; lines that do not fit are left out.
  void draw(const std::vector<std::string>& lines);

 private:
  termios before_{};
  bool keyboard_changed_ = false;
};

}  // namespace softgrip::tools
