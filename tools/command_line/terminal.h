#pragma once
// The terminal that a live view owns for a while, and gives back as it was.

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
/// What of a text is no ASCII and has a usual stand-in, by it where the locale is not UTF-8: +- for ±.
[[nodiscard]] std::string on_screen(std::string text);
/// Columns and rows of the standard output, or 80 and 24.
[[nodiscard]] std::size_t terminal_columns();
[[nodiscard]] std::size_t terminal_rows();

/// Takes SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP and SIGWINCH as a descriptor in place of their usual
/// effect.
[[nodiscard]] Descriptor take_ending_signals();

/// The signal that waits in that descriptor, or 0.
[[nodiscard]] int next_signal(const Descriptor& signals);

/// Full-screen drawing. The screen, the cursor and the keyboard are restored when it is destroyed, and by the
/// signals of a crash. At most one lives at a time.
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
  bool keyboard_changed_ = false;
};

}  // namespace softgrip::tools
