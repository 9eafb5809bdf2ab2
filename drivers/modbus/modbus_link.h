#pragma once
// A wire with Modbus modules at its other end: one question at a time, and an end at any doubt.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "base/descriptor.h"
#include "drivers/board/board.h"
#include "drivers/board/round_trip.h"
#include "drivers/modbus/modbus_address.h"
#include "drivers/modbus/modbus_reply.h"
#include "drivers/modbus/modbus_request.h"

struct _modbus;  // NOLINT(bugprone-reserved-identifier): so is libmodbus' modbus_t called

namespace softgrip::drivers {

/// On the network libmodbus receives; on a serial line it opens and sends. Around it: every wait
/// ends at a point in time on CLOCK_BOOTTIME [ns], never by the time between two bytes; a raw frame is
/// judged by our own pure check before anything in it is used; bytes behind it are looked for.
/// docs/explanation/libraries.md says what libmodbus leaves to us and why.
///
/// A repeated request is the same frame: a late repetition writes the same output values. It is sent within
/// the deadline of its exchange, and does not extend that deadline.
///
/// Nothing but the constructors, open() of a serial line, cost() and describe() allocates; nothing throws,
/// resolves names of hosts, or retries but where LinkHabits says so.
class ModbusLink {
 public:
  ModbusLink(const ModbusLink&) = delete;
  ModbusLink& operator=(const ModbusLink&) = delete;
  ModbusLink(ModbusLink&&) = delete;
  ModbusLink& operator=(ModbusLink&&) = delete;
  virtual ~ModbusLink();

  /// Opens the link, after closing the one there was.
  [[nodiscard]] BusStatus open(Nanoseconds deadline) noexcept;
  /// Waits until the settle time after open() is over. Bytes that come meanwhile are discarded.
  [[nodiscard]] BusStatus settle(Nanoseconds deadline) noexcept;
  void close() noexcept;
  [[nodiscard]] bool is_open() const noexcept { return descriptor() >= 0; }

  /// Asks, and waits for the answer. On `ok` and on `exception` the link stands; on anything else it was
  /// closed, so that a late or duplicated reply cannot be taken for the answer to a later question.
  [[nodiscard]] BusStatus ask(std::uint8_t unit, const ModbusRequest& request, Nanoseconds deadline) noexcept;
  /// What the last successful ask() read: bits or registers, high byte first. Valid until the next ask().
  [[nodiscard]] std::span<const std::uint8_t> data() const noexcept { return data_; }
  /// The exception code, if the last ask() ended in `exception`; else 0.
  [[nodiscard]] unsigned exception_code() const noexcept { return exception_code_; }
  /// What the last failure was.
  [[nodiscard]] const char* detail() const noexcept { return detail_.data(); }

  /// Measurements for cost(): none from now on; the last ask() was one.
  void forget_measurements() noexcept { measured_.reset(); }
  void keep_measurement() noexcept { measured_.add(answer_time(last_round_trip_)); }
  /// What these transactions take, one after the other, and how it adds up. `plan` says in words what they
  /// are.
  [[nodiscard]] virtual Board::Budget cost(std::span<const TransactionSize> transactions,
                                           const std::string& plan) const = 0;
  /// "127.0.0.1:502", "/dev/ttyUSB0 (115200 8N1)"
  [[nodiscard]] virtual std::string describe() const = 0;

 protected:
  /// Takes over a context of libmodbus; without one open() fails.
  ModbusLink(_modbus* context, const LinkHabits& habits, bool on_network) noexcept;

  [[nodiscard]] _modbus* context() const noexcept { return context_; }
  [[nodiscard]] int descriptor() const noexcept;
  /// Says why a link does not open.
  BusStatus refuse(BusStatus status, const char* what, const char* why) noexcept;
  /// Closes the link and says why.
  BusStatus fail(BusStatus status, const char* what, const char* why) noexcept;
  BusStatus wait_until_ready(short events, Nanoseconds deadline, const char* what) noexcept;
  /// Reads what the link holds after it was found ready.
  BusStatus read_some(std::span<std::uint8_t> bytes, const char* what, std::size_t& got) noexcept;
  /// Closes the link after the other end has closed it.
  BusStatus ended(const char* what) noexcept;
  [[nodiscard]] const RoundTrip& measured() const noexcept { return measured_; }

  /// The reason why bytes between two requests end a session.
  static constexpr const char* unasked = "bytes came that nobody asked for, a late or repeated reply";

  /// The judged answer; `error` is whole_frame, or the errno that made it less than a frame.
  struct Received {
    ModbusReply reply;
    int error = 0;
    std::span<const std::uint8_t> bytes = {};
  };
  static constexpr int whole_frame = 0;

  Descriptor held_;               ///< given back when the link closes
  Nanoseconds heard_at_ = 0;      ///< when the last bytes came
  bool answer_may_come_ = false;  ///< the last session ended while one was due

 private:
  virtual BusStatus connect(Nanoseconds deadline) noexcept = 0;
  /// Writes the frame of a question; returns its size, or 0 for one that reply_pdu_size() refuses.
  virtual std::size_t build(std::uint8_t unit, const ModbusRequest& request, Frame& frame) noexcept = 0;
  /// Waits until a question may be sent.
  virtual BusStatus before_asking(Nanoseconds) noexcept { return BusStatus::ok; }
  virtual BusStatus send(std::span<const std::uint8_t> frame, Nanoseconds deadline) noexcept = 0;
  /// The pure reply check over all that came since the question `asked` was sent.
  [[nodiscard]] virtual ModbusReply judge(std::span<const std::uint8_t> bytes, std::uint8_t unit,
                                          const ModbusRequest& request,
                                          std::span<const std::uint8_t> asked) const noexcept = 0;
  /// Receives with libmodbus into `buffer`, which is full of filler.
  virtual Received hear(std::span<std::uint8_t> buffer, std::uint8_t unit, const ModbusRequest& request,
                        std::span<const std::uint8_t> asked, Nanoseconds deadline) noexcept;
  /// Time to transmit a frame of this number of bytes after send().
  [[nodiscard]] virtual Nanoseconds sending_time(std::size_t) const noexcept { return 0; }
  /// numbers_answers(): true if an answer carries the number of its request. answers_previous(): true if
  /// these bytes carry the number of the previous request.
  [[nodiscard]] virtual bool numbers_answers() const noexcept { return false; }
  [[nodiscard]] virtual bool answers_previous(std::span<const std::uint8_t>) const noexcept { return false; }
  /// Largest number of bytes before or behind an answer that is discarded. It is below the size of the
  /// shortest answer, so the bytes cannot be an answer to another request.
  [[nodiscard]] virtual std::size_t most_stray() const noexcept { return 0; }
  /// Index of the unit id in a frame.
  [[nodiscard]] virtual std::size_t unit_place() const noexcept = 0;
  /// What of a round trip is kept as a measurement.
  [[nodiscard]] virtual Nanoseconds answer_time(Nanoseconds round_trip) const noexcept { return round_trip; }

  BusStatus send_until_heard(std::span<const std::uint8_t> frame, Nanoseconds deadline) noexcept;
  void expect_more_answers() noexcept;
  bool drop_strays() noexcept;
  ModbusReply receive(std::uint8_t unit, const ModbusRequest& request, std::span<const std::uint8_t> asked,
                      Nanoseconds deadline, int& error) noexcept;
  BusStatus drain(Nanoseconds until, Nanoseconds deadline, const char* what) noexcept;
  BusStatus name_failure(int error) noexcept;
  BusStatus conclude(const ModbusReply& reply, int error, std::uint8_t unit,
                     const ModbusRequest& request) noexcept;
  bool put_where_select_finds_it() noexcept;

  _modbus* context_;
  bool on_network_;
  Nanoseconds settle_;
  Nanoseconds repeat_after_;
  Nanoseconds opened_at_ = 0;
  bool answered_ = false;  ///< the other end has answered since the link was opened
  Nanoseconds first_asked_at_ = 0;
  Nanoseconds asked_at_ = 0;
  unsigned repeats_ = 0;         ///< of the last request
  unsigned stale_ = 0;           ///< numbered answers to the previous request that may still come
  Nanoseconds quiet_until_ = 0;  ///< end of the time in which other answers to it may still come
  /// libmodbus waits by select(), which knows no descriptor above 1023: the place of one is kept from the
  /// start.
  Descriptor place_;
  Frame outgoing_{};
  Frame incoming_{};
  std::span<const std::uint8_t> data_ = {};
  unsigned exception_code_ = 0;
  RoundTrip measured_;
  Nanoseconds last_round_trip_ = 0;
  std::array<char, 256> detail_{};
};

[[nodiscard]] std::unique_ptr<ModbusLink> make_link(const ModbusAddress& address);

}  // namespace softgrip::drivers
