#pragma once
// Controls the terminal for a live view and restores it afterwards. Asks the user to confirm an action.

#include <cstddef>
#include <string>
#include <vector>

#include "base/descriptor.h"

namespace softgrip::tools {

/// Returns true if the standard output is a terminal on which the program can move the cursor.
[[nodiscard]] bool on_terminal();
/// Returns true if the output is a terminal and the variable NO_COLOR is not set (https://no-color.org).
[[nodiscard]] bool wants_colour();
/// Returns true if the character encoding of the locale is UTF-8.
[[nodiscard]] bool has_unicode();
/// Replaces characters by similar ASCII characters if the locale is not UTF-8. For example, ± becomes +-.
[[nodiscard]] std::string on_screen(std::string text);
/// Returns the number of columns or rows of the terminal at the standard output. Without a terminal, returns
/// 80 columns and 24 rows.
[[nodiscard]] std::size_t terminal_columns();
[[nodiscard]] std::size_t terminal_rows();

/// Prints `question` and "[y/N]" to the standard error, and reads the answer from the standard input. Returns
/// true if the answer is "y", "Y" or "yes".
[[nodiscard]] bool confirmed(const std::string& question);

/// Blocks the signals for the whole process, so that they have no default action. Returns a descriptor that
/// reports the blocked signals.
[[nodiscard]] Descriptor take_signals(const std::vector<int>& signals);
/// Calls take_signals() for SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP and SIGWINCH.
[[nodiscard]] Descriptor take_ending_signals();

/// Returns the next signal that the descriptor reports, or 0 if there is none.
[[nodiscard]] int next_signal(const Descriptor& signals);

/// Draws on the full screen of the terminal. The destructor restores screen, cursor and keyboard; after a
/// crash, signal handlers restore them. At most one object may exist at a time.
class Screen {
 public:
  Screen();
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;
  Screen(Screen&&) = delete;
  Screen& operator=(Screen&&) = delete;
  ~Screen();

  /// Replaces the displayed lines. Omits the lines that do not fit on the screen.
  void draw(const std::vector<std::string>& lines);

 private:
  bool keyboard_changed_ = false;
};

}  // namespace softgrip::tools
