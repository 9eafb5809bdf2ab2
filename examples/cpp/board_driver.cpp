// Shows a board driver. The board of this example answers "SET 12.500\n" with "POS 2.500\n". A thread of the
// program simulates this board. board_driver writes three commands and prints the readings.

#include <poll.h>
#include <softgrip/board.h>
#include <sys/socket.h>
#include <unistd.h>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <thread>
#include <utility>

using namespace std::chrono;
using softgrip::BusStatus;

/// After a failed exchange, a late response can still arrive. Therefore, connect() opens a new connection.
/// `dial` returns a connected socket or -1. For a serial line, replace ::send() by ::write().
class LineBoard final : public softgrip::Board {
 public:
  explicit LineBoard(int (*dial)()) : dial_(dial) {}
  ~LineBoard() override { ::close(line_); }
  std::size_t channels() const noexcept override { return 1; }
  BusStatus connect(nanoseconds) noexcept override {
    ::close(std::exchange(line_, -1));  // before the call of dial_(), because the board may permit one client
    return (line_ = dial_()) >= 0 ? BusStatus::ok : failed(BusStatus::disconnected, errno);
  }
  BusStatus exchange(std::span<const double> commands_kpa, std::span<softgrip::Reading> readings,
                     nanoseconds deadline) noexcept override {
    const auto end = steady_clock::now() + deadline;
    char text[64] = "";
    const int length = std::snprintf(text, sizeof text, "SET %.3f\n", commands_kpa[0]);
    if (::send(line_, text, length, MSG_NOSIGNAL) != length) return failed(BusStatus::disconnected, errno);
    for (std::size_t size = 0; size == 0 || text[size - 1] != '\n'; text[size] = '\0') {
      pollfd input{line_, POLLIN, 0};
      const auto left = ceil<milliseconds>(end - steady_clock::now()).count();
      const int ready = left < 0 ? 0 : ::poll(&input, 1, static_cast<int>(left));
      if (ready < 0 && errno == EINTR) continue;  // a signal interrupted poll()
      if (ready != 1) return failed(BusStatus::timed_out, ETIMEDOUT);
      const ssize_t received = ::read(line_, text + size, sizeof text - 1 - size);
      if (received <= 0) return failed(BusStatus::disconnected, received == 0 ? ECONNRESET : errno);
      size += received;
    }
    softgrip::Reading now{.sequence = readings[0].sequence + 1, .validity = softgrip::Validity::valid};
    if (std::sscanf(text, "POS %lf", &now.displacement) != 1) return failed(BusStatus::bad_reply, EBADMSG);
    now.sampled_at = steady_clock::now().time_since_epoch();
    readings[0] = now;
    return BusStatus::ok;
  }
  std::string detail() const override { return std::generic_category().message(error_); }
  std::string describe() const override { return "line board"; }

 private:
  BusStatus failed(BusStatus status, int error) noexcept {
    ::close(std::exchange(line_, -1));
    error_ = error == EBADF ? ENOTCONN : error;  // a call without a connection fails with EBADF
    return status;
  }
  int (*dial_)();
  int line_ = -1, error_ = 0;
};

int main() {
  LineBoard board([] {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) return -1;
    std::thread([line = ends[1]] {
      for (char text[64] = ""; ::read(line, text, sizeof text - 1) > 0;)
        ::send(line, text, std::snprintf(text, 64, "POS %.3f\n", 0.2 * std::stod(text + 4)), MSG_NOSIGNAL);
    }).detach();
    return ends[0];
  });
  if (board.connect(1s) != BusStatus::ok) return 1;
  softgrip::Reading reading;
  for (const double command_kpa : {0.0, 10.0, 20.0}) {
    const BusStatus status = board.exchange({&command_kpa, 1}, {&reading, 1}, 1s);
    std::printf("%4.1f kPa: %s, %.1f mm\n", command_kpa, name_of(status).c_str(), reading.displacement);
    if (status != BusStatus::ok) return 1;
  }
}
