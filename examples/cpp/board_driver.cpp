// Shows a board driver. The board of this example is connected through a socket and answers "SET 12.500\n"
// with "POS 2.500\n". A thread of the program simulates this board. board_driver writes three commands to the
// board and prints the readings.

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>
#include <chrono>
#include <cstdio>
#include <string>
#include <thread>

#include <softgrip/board.h>

using softgrip::BusStatus;

class LineBoard final : public softgrip::Board {
 public:
  explicit LineBoard(int line) : line_(line) {}
  std::size_t channels() const noexcept override { return 1; }
  BusStatus connect(std::chrono::nanoseconds) noexcept override { return BusStatus::ok; }

  BusStatus exchange(std::span<const double> commands_kpa, std::span<softgrip::Reading> readings,
                     std::chrono::nanoseconds deadline) noexcept override {
    char text[64];
    const int length = std::snprintf(text, sizeof text, "SET %.3f\n", commands_kpa[0]);
    if (::write(line_, text, static_cast<std::size_t>(length)) != length) return failed("write");
    pollfd input{line_, POLLIN, 0};
    const auto wait_ms = std::chrono::ceil<std::chrono::milliseconds>(deadline).count();
    if (::poll(&input, 1, static_cast<int>(wait_ms)) != 1) {
      detail_ = "no response within the deadline";
      return BusStatus::timed_out;
    }
    const ssize_t received = ::read(line_, text, sizeof text - 1);
    if (received <= 0) return failed("read");
    text[received] = '\0';
    double position_mm = 0;
    if (std::sscanf(text, "POS %lf", &position_mm) != 1) return BusStatus::bad_reply;
    readings[0].displacement = position_mm;
    readings[0].sampled_at = std::chrono::steady_clock::now().time_since_epoch();
    readings[0].sequence += 1;
    readings[0].validity = softgrip::Validity::valid;
    return BusStatus::ok;
  }
  std::string detail() const override { return detail_; }
  std::string describe() const override { return "line board"; }

 private:
  BusStatus failed(const char* what) noexcept {
    detail_ = what;
    return BusStatus::disconnected;
  }
  int line_;
  const char* detail_ = "";
};

int main() {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) return 1;
  std::thread device([line = ends[1]] {
    char text[64];
    double command_kpa = 0;
    for (ssize_t n = 0; (n = ::read(line, text, sizeof text - 1)) > 0;) {
      text[n] = '\0';
      if (std::sscanf(text, "SET %lf", &command_kpa) == 1) ::dprintf(line, "POS %.3f\n", 0.2 * command_kpa);
    }
  });
  LineBoard board(ends[0]);
  softgrip::Reading reading;
  bool good = true;
  for (const double command_kpa : {0.0, 10.0, 20.0}) {
    const BusStatus status = board.exchange({&command_kpa, 1}, {&reading, 1}, std::chrono::seconds(1));
    std::printf("%4.1f kPa: %s, %.1f mm\n", command_kpa, name_of(status).c_str(), reading.displacement);
    good = good && status == BusStatus::ok;
  }
  ::shutdown(ends[0], SHUT_RDWR);
  device.join();
  return good ? 0 : 1;
}
