// Tests the driver of examples/cpp/board_driver.cpp with boards that respond late, slowly, with interruptions
// by signals, or not at all. Prints the status and the reason of each connection and exchange.

#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <string>
#include <thread>

#include <softgrip/board.h>

// The renamed function main() of the example has no return statement.
#pragma GCC diagnostic ignored "-Wreturn-type"
#define main example_main
#include "board_driver.cpp"
#undef main

/// Returns one end of a connection. A thread serves the other end.
int connection_to(void (*serve)(int)) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) return -1;
  std::thread([serve, line = ends[1]] {
    serve(line);
    ::close(line);
  }).detach();
  return ends[0];
}

/// Sends "POS" and the number in two parts. The response to 10 kPa comes 1.2 s after the command.
void serve_late(int line) {
  for (char text[64] = ""; ::read(line, text, sizeof text - 1) > 0;) {
    const double command_kpa = std::stod(text + 4);
    if (command_kpa == 10) std::this_thread::sleep_for(1200ms);
    if (::send(line, "POS ", 4, MSG_NOSIGNAL) != 4) return;
    std::this_thread::sleep_for(50ms);
    const std::string number = std::to_string(0.2 * command_kpa) + "\n";
    if (::send(line, number.data(), number.size(), MSG_NOSIGNAL) < 0) return;
  }
}

void serve_bytewise(int line) {
  for (const char byte : std::string("POS 1.000\n")) {
    std::this_thread::sleep_for(300ms);
    if (::send(line, &byte, 1, MSG_NOSIGNAL) != 1) return;
  }
}

void serve_nothing(int line) {
  char text[64];
  (void)!::read(line, text, sizeof text);
}

void serve_error(int line) {
  (void)::send(line, "ERR\n", 4, MSG_NOSIGNAL);
  serve_nothing(line);
}

int refuse() {
  errno = ECONNREFUSED;
  return -1;
}

/// Permits one client: refuses a connection until the previous client has closed its connection.
int dial_single() {
  static int previous = -1;
  char byte = 0;
  if (previous >= 0 && ::recv(previous, &byte, 1, MSG_DONTWAIT) != 0) return refuse();
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) return -1;
  previous = ends[1];
  return ends[0];
}

BusStatus connect(LineBoard& board) {
  const BusStatus status = board.connect(1s);
  std::printf("connect: %s", name_of(status).c_str());
  std::printf(status == BusStatus::ok ? "\n" : " (%s)\n", board.detail().c_str());
  return status;
}

void exchange(LineBoard& board, double command_kpa) {
  softgrip::Reading reading{.displacement = -1};
  const auto begin = steady_clock::now();
  const BusStatus status = board.exchange({&command_kpa, 1}, {&reading, 1}, 1s);
  std::printf("%.0f kPa: %s, %.1f mm", command_kpa, name_of(status).c_str(), reading.displacement);
  if (status != BusStatus::ok) std::printf(" (%s)", board.detail().c_str());
  std::printf(steady_clock::now() - begin < 1500ms ? "\n" : ", too late\n");
}

int main() {
  std::puts("late responses");
  LineBoard late([] { return connection_to(serve_late); });
  connect(late);
  for (const double command_kpa : {5.0, 10.0, 20.0}) exchange(late, command_kpa);
  connect(late);
  exchange(late, 30);

  std::puts("signals during an exchange");
  struct sigaction ignored {};
  ignored.sa_handler = [](int) {};
  ::sigaction(SIGALRM, &ignored, nullptr);
  itimerval every_10_ms{{0, 10000}, {0, 10000}};
  ::setitimer(ITIMER_REAL, &every_10_ms, nullptr);
  exchange(late, 40);
  exchange(late, 10);
  every_10_ms = {};
  ::setitimer(ITIMER_REAL, &every_10_ms, nullptr);

  std::puts("one byte per 0.3 s, a closed connection, an error, and no board");
  for (const auto dial :
       {+[] { return connection_to(serve_bytewise); }, +[] { return connection_to(serve_nothing); },
        +[] { return connection_to(serve_error); }, &refuse}) {
    LineBoard board(dial);
    if (connect(board) == BusStatus::ok) exchange(board, 1);
  }

  std::puts("a board that permits one client");
  LineBoard single(dial_single);
  connect(single);
  connect(single);
}
