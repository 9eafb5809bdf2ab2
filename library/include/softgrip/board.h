#pragma once
/// @file
/// The interface of I/O boards, and a simulated board. Stable.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <softgrip/export.h>
#include <softgrip/model.h>

namespace softgrip {

/// Reason why a reading can or cannot be used.
enum class Validity : std::uint8_t {
  valid,         ///< usable
  none_yet,      ///< no response so far
  out_of_range,  ///< outside the electrical range of the sensor
  sensor_error,  ///< an error code of the sensor or of the board
  jumped,        ///< changed faster than the finger can move
  frozen,        ///< constant while the command changed
  stale,         ///< older than permitted
};

/// Reading of one channel.
struct Reading {
  double displacement = 0;  ///< displacement in the unit of the model
  double pressure_kpa =
      std::numeric_limits<double>::quiet_NaN();  ///< measured pressure [kPa]; NaN: no sensor
  double temperature_c =
      std::numeric_limits<double>::quiet_NaN();  ///< temperature [degrees Celsius]; NaN: no sensor
  std::chrono::nanoseconds sampled_at{0};        ///< time of the sample
  std::uint32_t sequence = 0;                    ///< number of responses so far
  Validity validity = Validity::none_yet;        ///< assessment by the driver
};

/// Result of an exchange with a board.
enum class BusStatus : std::uint8_t {
  ok,                ///< commands written, readings taken
  disconnected,      ///< no session; call connect()
  timed_out,         ///< the deadline passed
  bad_reply,         ///< the response is malformed
  exception,         ///< the board returned an error
  write_refused,     ///< the outputs did not take the commanded values
  overwritten,       ///< another client also writes the outputs
  watchdog_tripped,  ///< the watchdog of the board holds the outputs at their safe value
  closed_at_once,    ///< the connection was closed before its first response
};
/// Returns the name of the enumerator.
[[nodiscard]] SOFTGRIP_API std::string name_of(BusStatus status);

/// An I/O board with one output and one set of inputs per channel. Derive from it to write a driver. All
/// calls come from one thread.
class SOFTGRIP_API Board {
 public:
  Board() = default;
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;
  virtual ~Board();

  /// Returns the number of channels.
  [[nodiscard]] virtual std::size_t channels() const noexcept = 0;
  /// Opens or reopens the session. The call may block until the deadline. The outputs keep their values.
  /// @param deadline  longest duration of the call
  [[nodiscard]] virtual BusStatus connect(std::chrono::nanoseconds deadline) noexcept = 0;
  /// Writes one pressure per channel and reads all channels. If the result is not `ok`, the readings are
  /// unchanged. The function must not allocate.
  /// @param commands_kpa  commands [kPa], channels() values
  /// @param readings      channels() values, written by the call
  /// @param deadline      longest duration of the call
  [[nodiscard]] virtual BusStatus exchange(std::span<const double> commands_kpa, std::span<Reading> readings,
                                           std::chrono::nanoseconds deadline) noexcept = 0;
  /// Returns the reason of the last failure of connect() or exchange().
  [[nodiscard]] virtual std::string detail() const;
  /// Returns one line for display: product, address.
  [[nodiscard]] virtual std::string describe() const = 0;
};

/// An object that a finger touches.
struct SimulatedObject {
  double position = 0;    ///< displacement at contact, in the unit of the model
  double yielding = 0.1;  ///< motion beyond the contact relative to free motion: 0 (rigid) to 1 (no effect)
};

/// One channel of a SimulatedBoard.
struct SimulatedFinger {
  Model model;                                 ///< model of the finger
  std::optional<SimulatedObject> object = {};  ///< object that is present from the start
  double noise = 0;                            ///< standard deviation of a reading, >= 0
  double pressure_min_kpa = 0;                 ///< lower end of the output [kPa]
  double pressure_max_kpa = 100;               ///< upper end of the output [kPa]
  std::uint64_t seed = 1;                      ///< seed of all noise
};

/// A simulated board whose fingers are models. Only advance() advances its clock. Equal settings and equal
/// calls give bit-identical readings. The daemon uses the same simulated board.
class SOFTGRIP_API SimulatedBoard final : public Board {
 public:
  /// Creates a board. Throws InvalidArgument.
  /// @param fingers  one per channel, 1 to 16
  /// @param tick_s   usual period of exchange() [s], > 0
  explicit SimulatedBoard(std::vector<SimulatedFinger> fingers, double tick_s = 0.005);
  ~SimulatedBoard() override;

  [[nodiscard]] std::size_t channels() const noexcept override;
  [[nodiscard]] BusStatus connect(std::chrono::nanoseconds deadline) noexcept override;
  [[nodiscard]] BusStatus exchange(std::span<const double> commands_kpa, std::span<Reading> readings,
                                   std::chrono::nanoseconds deadline) noexcept override;
  [[nodiscard]] std::string detail() const override;
  [[nodiscard]] std::string describe() const override;

  /// Returns the time of the board's clock, which begins at 1 s.
  [[nodiscard]] std::chrono::nanoseconds now() const noexcept;
  /// Advances the clock. A negative duration is ignored.
  void advance(std::chrono::nanoseconds duration) noexcept;
  /// Places an object at the finger of a channel. An empty `object` removes it. A call for an unknown channel
  /// has no effect.
  void set_object(std::size_t channel, const std::optional<SimulatedObject>& object) noexcept;
  /// Returns the displacement of the finger without the errors of its sensor; NaN for an unknown channel.
  [[nodiscard]] double displacement(std::size_t channel) const noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace softgrip
