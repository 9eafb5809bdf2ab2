#pragma once
// A serial module on a pseudo-terminal. The test specifies its response to each request. The module uses no
// code of drivers/, because the same error in the module and the driver would remain undetected.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace softgrip::drivers::test {

using Bytes = std::vector<std::uint8_t>;

/// Returns the bytes and, after them, the checksum of a serial frame.
[[nodiscard]] Bytes checked(Bytes bytes);

class ScriptedLine {
 public:
  /// Function that sends the response to a request. `index` is the number of the request, from 0. `request`
  /// contains all bytes that arrived before the line was quiet for 3 ms.
  using Handler = std::function<void(ScriptedLine& line, const Bytes& request, std::size_t index)>;

  /// Opens a pseudo-terminal. If `name` is not empty, creates a link with the path `name` to the
  /// pseudo-terminal. Otherwise, device() returns the path of the pseudo-terminal.
  explicit ScriptedLine(Handler handler, std::string name = "");
  ScriptedLine(const ScriptedLine&) = delete;
  ScriptedLine& operator=(const ScriptedLine&) = delete;
  ScriptedLine(ScriptedLine&&) = delete;
  ScriptedLine& operator=(ScriptedLine&&) = delete;
  /// Closes the pseudo-terminal, as if the serial adapter were unplugged.
  ~ScriptedLine();

  [[nodiscard]] const std::string& device() const { return device_; }
  void send(const Bytes& bytes);
  void drip(const Bytes& bytes, std::chrono::milliseconds pause);
  static void wait(std::chrono::milliseconds duration) { std::this_thread::sleep_for(duration); }

 private:
  void serve();

  Handler handler_;
  int master_ = -1;
  int kept_ = -1;
  std::string device_;
  std::string name_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace softgrip::drivers::test
