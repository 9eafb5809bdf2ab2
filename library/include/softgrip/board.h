#pragma once
/// @file
/// Declares the interface of I/O boards, and a simulated board. The changelog announces every incompatible
/// change of this interface.

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

/// The validity of a reading: `valid`, or the reason why the reading cannot be used.
enum class Validity : std::uint8_t {
  valid,         ///< the reading can be used
  none_yet,      ///< the board has not sent a first response yet
  out_of_range,  ///< the signal is outside the electrical range of the sensor
  sensor_error,  ///< the sensor or the board reported an error code
  jumped,        ///< the reading changed faster than a finger can move
  frozen,        ///< the reading did not change although the command changed
  stale,         ///< the reading is older than the permitted age
};

/// Reading of one channel.
struct Reading {
  double displacement = 0;  ///< measured displacement in the unit of the model
  double pressure_kpa = std::numeric_limits<double>::quiet_NaN();  ///< measured pressure [kPa]; NaN: the
                                                                   ///< channel has no pressure sensor
  double temperature_c =
      std::numeric_limits<double>::quiet_NaN();  ///< measured temperature [degrees Celsius]; NaN: the channel
                                                 ///< has no temperature sensor
  std::chrono::nanoseconds sampled_at{0};        ///< time at which the sensor was sampled
  std::uint32_t sequence = 0;                    ///< number of responses that the board has sent so far
  Validity validity = Validity::none_yet;        ///< validity of the reading according to the driver
};

/// Result of an exchange with a board.
enum class BusStatus : std::uint8_t {
  ok,                ///< the commands were written and the readings taken
  disconnected,      ///< no connection to the board; connect() must be called
  timed_out,         ///< the deadline passed before the exchange was complete
  bad_reply,         ///< the response of the board is malformed
  exception,         ///< the board returned an error code
  write_refused,     ///< the outputs did not change to the commanded values
  overwritten,       ///< another client also writes to the outputs of the board
  watchdog_tripped,  ///< the watchdog of the board holds the outputs at their safe value
  closed_at_once,    ///< the connection was closed before the first response
};
/// Returns the name of a status of the bus, for example "timed_out".
[[nodiscard]] SOFTGRIP_API std::string name_of(BusStatus status);

/// An I/O board with one output and one set of inputs per channel. To write a driver for a board, derive a
/// class from Board. One thread calls all functions.
class SOFTGRIP_API Board {
 public:
  Board() = default;
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;
  virtual ~Board();

  /// Returns the number of channels.
  [[nodiscard]] virtual std::size_t channels() const noexcept = 0;
  /// Opens or reopens the connection to the board. The call may block until the deadline. The outputs of the
  /// board keep their values.
  /// @param deadline  longest duration of the call
  [[nodiscard]] virtual BusStatus connect(std::chrono::nanoseconds deadline) noexcept = 0;
  /// Writes one pressure per channel and reads all channels. If the result is not `ok`, the readings do not
  /// change. The function must not allocate memory.
  /// @param commands_kpa  commands [kPa], channels() values
  /// @param readings      channels() values, written by the call
  /// @param deadline      longest duration of the call
  [[nodiscard]] virtual BusStatus exchange(std::span<const double> commands_kpa, std::span<Reading> readings,
                                           std::chrono::nanoseconds deadline) noexcept = 0;
  /// Returns the reason why the last connect() or exchange() failed.
  [[nodiscard]] virtual std::string detail() const;
  /// Returns a description of the board for the user, in one line with product and address.
  [[nodiscard]] virtual std::string describe() const = 0;
};

/// An object that a simulated finger touches when its displacement reaches `position`.
struct SimulatedObject {
  double position = 0;    ///< displacement at contact, in the unit of the model
  double yielding = 0.1;  ///< ratio of the motion beyond the contact to the motion without an object: 0
                          ///< (rigid object) to 1 (object without effect)
};

/// One channel of a SimulatedBoard.
struct SimulatedFinger {
  Model model;                                 ///< model of the simulated finger
  std::optional<SimulatedObject> object = {};  ///< object that is present from the start
  double noise = 0;                            ///< standard deviation of the noise of a reading, in the unit
                                               ///< of the model; >= 0
  double pressure_min_kpa = 0;                 ///< smallest output pressure of the board [kPa]
  double pressure_max_kpa = 100;               ///< largest output pressure of the board [kPa]
  std::uint64_t seed = 1;                      ///< seed of the random numbers for the noise of all sensors
};

/// A simulated board to which simulated fingers are connected. The clock of the board changes only in
/// advance(). If two boards have equal settings and receive equal calls, their readings are identical in
/// every bit. The daemon uses this simulated board too.
class SOFTGRIP_API SimulatedBoard final : public Board {
 public:
  /// Creates a board. Throws InvalidArgument if an argument is invalid.
  /// @param fingers  settings of the fingers, one entry per channel; 1 to 16 entries
  /// @param tick_s   usual time between two calls of exchange() [s], at least 1e-6 and at least 1/100000 of
  /// the
  ///                 dead time of each model
  explicit SimulatedBoard(std::vector<SimulatedFinger> fingers, double tick_s = 0.005);
  ~SimulatedBoard() override;

  [[nodiscard]] std::size_t channels() const noexcept override;
  [[nodiscard]] BusStatus connect(std::chrono::nanoseconds deadline) noexcept override;
  [[nodiscard]] BusStatus exchange(std::span<const double> commands_kpa, std::span<Reading> readings,
                                   std::chrono::nanoseconds deadline) noexcept override;
  [[nodiscard]] std::string detail() const override;
  [[nodiscard]] std::string describe() const override;

  /// Returns the time of the board's clock, which starts at 1 s.
  [[nodiscard]] std::chrono::nanoseconds now() const noexcept;
  /// Advances the clock of the board by `duration`. A negative duration has no effect. The next call of
  /// exchange(), displacement() or set_object() simulates this duration, so its computation time increases
  /// with the duration.
  void advance(std::chrono::nanoseconds duration) noexcept;
  /// Places an object at the finger of a channel at the time now(), or removes the object if `object` is
  /// empty. A call for an unknown channel or with an invalid object has no effect.
  void set_object(std::size_t channel, const std::optional<SimulatedObject>& object) noexcept;
  /// Returns the true displacement of the finger at the time now(), without the errors of its sensor; NaN for
  /// an unknown channel.
  [[nodiscard]] double displacement(std::size_t channel) const noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace softgrip
