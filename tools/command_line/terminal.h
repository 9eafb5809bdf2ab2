#pragma once
// Controls the terminal for a live view and restores it afterwards.

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

#include "base/descriptor.h"

namespace softgrip::tools {

/// Returns true if the standard output is a terminal that can move its cursor.
[[nodiscard]] bool on_terminal();
/// Returns true unless NO_COLOR is set (https://no-color.org) or the output is not a terminal.
[[nodiscard]] bool wants_colour();
/// Returns true if the character encoding of the locale is UTF-8.
[[nodiscard]] bool has_unicode();
/// Replaces characters by their usual ASCII form if the locale is not UTF-8: ± becomes +-.
[[nodiscard]] std::string on_screen(std::string text);
/// Returns the columns and rows of the standard output, or 80 and 24.
[[nodiscard]] std::size_t terminal_columns();
[[nodiscard]] std::size_t terminal_rows();

/// Blocks the default action of SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP and SIGWINCH and returns a
/// descriptor that reports these signals.
[[nodiscard]] Descriptor take_ending_signals();

/// Returns the next signal of the descriptor, or 0 if there is none.
[[nodiscard]] int next_signal(const Descriptor& signals);

/// Full-screen drawing. The destructor restores screen, cursor and keyboard. Signal handlers do this after a
/// crash. At most one object may exist at a time.
class Screen {
 public:
  Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;
  Screen(Screen&&) = delete;
  Screen& operator=(Screen&&) = delete;
  ~Screen();

  /// Replaces the displayed lines. Lines that do not fit are omitted.
  void draw(const std::vector<std::string>& lines);

 private:
  bool keyboard_changed_ = false;
};

}  // namespace softgrip::tools
