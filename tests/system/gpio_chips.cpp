// Simulates a GPIO chip in a softgripd process (LD_PRELOAD). A test in another process sets and reads the
// lines of the chip:
//
//   GPIO_CHIPS=/tmp/folder LD_PRELOAD=.../libgpio_chips.so softgripd ...
//
// tests/drivers/gpio/fake_gpio_1.cpp or _2.cpp replace libgpiod's functions. The folder replaces /dev in the
// search for chips. Its socket `lines` accepts one request per line, from one client at a time:
//
//   high NAME AT_NS   the level changes to high; the kernel's time of the edge is AT_NS (CLOCK_MONOTONIC)
//   low NAME AT_NS    the level changes to low
//   gone              the chip is removed
//   levels            returns the names of all lines that are high
//
// If GPIO_TWIN is set, a second chip with the same label exists.
//
// The answer to a request is "ok" or the names. A paused process does not answer. When the process continues,
// it executes the waiting requests with their own times, like the kernel's queue of edges.

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>

#include "tests/drivers/gpio/fake_gpio.h"

namespace {

using softgrip::drivers::testing::fake_chips;
using softgrip::drivers::testing::FakeChip;
using softgrip::drivers::testing::FakeLine;

std::string folder() {
  const char* const named = std::getenv("GPIO_CHIPS");
  return named == nullptr ? "" : named;
}

std::string answer(const std::string& request) {
  const auto held = softgrip::drivers::testing::hold_fake_lines();
  std::istringstream words(request);
  std::string verb;
  std::string name;
  std::int64_t at_ns = 0;
  words >> verb >> name >> at_ns;
  std::string high;
  for (FakeLine& line : fake_chips().front().lines) {
    if (verb == "gone") line.gone = true;
    if (line.name == name && (verb == "high" || verb == "low")) line.change(verb == "high", at_ns);
    if (verb == "levels" && line.high) high += line.name + " ";
  }
  return verb == "levels" ? high : "ok";
}

void serve(int listening) {
  for (;;) {
    const int client = ::accept(listening, nullptr, nullptr);
    if (client < 0) return;
    std::FILE* const lines = ::fdopen(client, "r+");
    char request[200];
    while (std::fgets(request, sizeof request, lines) != nullptr) {
      const std::string said = answer(request) + "\n";
      if (::send(client, said.data(), said.size(), MSG_NOSIGNAL) < 0) break;
    }
    std::fclose(lines);
  }
}

[[gnu::constructor]] void plug_in() {
  if (folder().empty()) return;
  FakeChip chip;
  chip.name = "gpiochip0";
  chip.label = "preloaded";
  for (const char* name : {"ESTOP", "PART", "ENABLE", "READY", "FAULT"}) {
    FakeLine line;
    line.name = name;
    chip.lines.push_back(line);
  }
  fake_chips().push_back(chip);
  const std::ofstream empty(folder() + "/gpiochip0");
  if (std::getenv("GPIO_TWIN") != nullptr) {
    chip.name = "gpiochip1";
    fake_chips().push_back(chip);
    const std::ofstream twin(folder() + "/gpiochip1");
  }
  const int listening = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::snprintf(address.sun_path, sizeof address.sun_path, "%s/lines", folder().c_str());
  if (::bind(listening, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(listening, 1) != 0) {
    std::perror("gpio_chips");
    std::abort();
  }
  // Blocks all signals in this thread, so that the threads of softgripd receive them.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  std::thread(serve, listening).detach();
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

}  // namespace

/// Opens the folder GPIO_CHIPS instead of /dev. std::filesystem lists a folder with openat().
extern "C" int openat(int at, const char* path, int flags, ...) {
  using Openat = int (*)(int, const char*, int, ...);
  static const auto real = reinterpret_cast<Openat>(dlsym(RTLD_NEXT, "openat"));
  va_list more;
  va_start(more, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(more, mode_t) : 0;
  va_end(more);
  const bool devices = std::strcmp(path, "/dev") == 0 && !folder().empty();
  return real(at, devices ? folder().c_str() : path, flags, mode);
}
