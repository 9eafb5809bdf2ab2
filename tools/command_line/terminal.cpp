#include "tools/command_line/terminal.h"

#include <langinfo.h>
#include <sys/ioctl.h>
#include <sys/signalfd.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <clocale>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <string_view>

namespace softgrip::tools {
namespace {

winsize window() {
  winsize size{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) size = {24, 80, 0, 0};
  return size;
}

void put(std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(STDOUT_FILENO, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return;
    text.remove_prefix(static_cast<std::size_t>(count));
  }
}

constexpr std::string_view enter_screen = "\x1b[?1049h\x1b[?25l";  // selects the alternate screen and hides
                                                                   // the cursor
constexpr std::string_view leave_screen = "\x1b[?25h\x1b[?1049l";

constexpr std::array<int, 6> crashes{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS};
std::array<struct sigaction, crashes.size()> before_crashes;
termios keyboard_before;
volatile std::sig_atomic_t keyboard_to_restore = 0;

extern "C" void softgrip_restore_terminal(int signal) {
  put(leave_screen);
  if (keyboard_to_restore != 0) ::tcsetattr(STDIN_FILENO, TCSANOW, &keyboard_before);
  ::raise(signal);  // ends the program, because SA_RESETHAND has restored the default action of the signal
}

}  // namespace

bool on_terminal() {
  const char* kind = std::getenv("TERM");
  return ::isatty(STDOUT_FILENO) == 1 && kind != nullptr && std::strcmp(kind, "dumb") != 0;
}

bool wants_colour() {
  const char* refused = std::getenv("NO_COLOR");
  return on_terminal() && (refused == nullptr || *refused == '\0');
}

bool has_unicode() {
  std::setlocale(LC_CTYPE, "");
  const bool utf8 = std::strcmp(::nl_langinfo(CODESET), "UTF-8") == 0;
  std::setlocale(LC_CTYPE, "C");
  return utf8;
}

std::string on_screen(std::string text) {
  constexpr std::string_view plus_minus = "±";
  if (has_unicode()) return text;
  for (std::size_t at = 0; (at = text.find(plus_minus, at)) != std::string::npos;)
    text.replace(at, plus_minus.size(), "+-");
  return text;
}

std::size_t terminal_columns() {
  return window().ws_col;
}

std::size_t terminal_rows() {
  return std::max<std::size_t>(window().ws_row, 1);
}

bool confirmed(const std::string& question) {
  std::fprintf(stderr, "%s [y/N] ", question.c_str());
  std::string answer;
  return std::getline(std::cin, answer) && (answer == "y" || answer == "Y" || answer == "yes");
}

Descriptor take_signals(const std::vector<int>& signals) {
  sigset_t set;
  sigemptyset(&set);
  for (const int signal : signals) sigaddset(&set, signal);
  sigprocmask(SIG_BLOCK, &set, nullptr);
  return Descriptor{signalfd(-1, &set, SFD_CLOEXEC)};
}

Descriptor take_ending_signals() {
  return take_signals({SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP, SIGWINCH});
}

int next_signal(const Descriptor& signals) {
  signalfd_siginfo info{};
  const bool came = ::read(signals.get(), &info, sizeof info) == static_cast<ssize_t>(sizeof info);
  return came ? static_cast<int>(info.ssi_signo) : 0;
}

Screen::Screen() {
  if (::isatty(STDIN_FILENO) == 1 && ::tcgetattr(STDIN_FILENO, &keyboard_before) == 0) {
    termios raw = keyboard_before;
    raw.c_lflag &= static_cast<tcflag_t>(~(ICANON | ECHO));
    keyboard_changed_ = ::tcsetattr(STDIN_FILENO, TCSANOW, &raw) == 0;
    keyboard_to_restore = keyboard_changed_ ? 1 : 0;
  }
  struct sigaction action {};
  action.sa_handler = softgrip_restore_terminal;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_NODEFER);
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < crashes.size(); ++i) ::sigaction(crashes[i], &action, &before_crashes[i]);
  put(enter_screen);
}

Screen::~Screen() {
  put(leave_screen);
  if (keyboard_changed_) ::tcsetattr(STDIN_FILENO, TCSANOW, &keyboard_before);
  keyboard_to_restore = 0;
  for (std::size_t i = 0; i < crashes.size(); ++i) ::sigaction(crashes[i], &before_crashes[i], nullptr);
}

void Screen::draw(const std::vector<std::string>& lines) {
  // Write everything at once to avoid flicker. Clear each line before writing it: after a line that fills the
  // last column, the cursor is still on the last character of this line.
  std::string frame = "\x1b[H";
  const std::size_t rows = std::min<std::size_t>(lines.size(), window().ws_row);
  for (std::size_t i = 0; i < rows; ++i) frame += (i > 0 ? "\r\n\x1b[2K" : "\x1b[2K") + lines[i];
  if (rows < window().ws_row) frame += "\r\n\x1b[J";
  put(frame);
}

}  // namespace softgrip::tools
