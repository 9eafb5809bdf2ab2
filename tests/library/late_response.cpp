// Tests the driver of examples/cpp/board_driver.cpp with a board whose response to 10 kPa comes 1.2 s after
// the command. Prints the status of each exchange and connection.

#include <sys/socket.h>
#include <unistd.h>
#include <chrono>
#include <cstdio>
#include <string>
#include <thread>

#include <softgrip/board.h>

// The renamed function main() of the example has no return statement.
#pragma GCC diagnostic ignored "-Wreturn-type"
#define main example_main
#include "board_driver.cpp"
#undef main

/// Connects to a thread that simulates the board. The board sends "POS" and the number in two parts.
int dial_slow() {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) return -1;
  std::thread([line = ends[1]] {
    for (char text[64] = ""; ::read(line, text, sizeof text - 1) > 0;) {
      const double command_kpa = std::stod(text + 4);
      if (command_kpa == 10) std::this_thread::sleep_for(1200ms);
      if (::send(line, "POS ", 4, MSG_NOSIGNAL) != 4) return;
      std::this_thread::sleep_for(50ms);
      ::dprintf(line, "%.3f\n", 0.2 * command_kpa);
    }
  }).detach();
  return ends[0];
}

int main() {
  LineBoard board(dial_slow);
  softgrip::Reading reading;
  const auto exchange = [&](double command_kpa) {
    const BusStatus status = board.exchange({&command_kpa, 1}, {&reading, 1}, 1s);
    std::printf("%.0f kPa: %s, %.1f mm\n", command_kpa, name_of(status).c_str(), reading.displacement);
  };
  (void)board.connect(1s);
  exchange(5);
  exchange(10);
  exchange(20);
  std::printf("connect: %s\n", name_of(board.connect(1s)).c_str());
  exchange(30);
}
