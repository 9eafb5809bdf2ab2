#pragma once
// Implements a link to Modbus modules. The link sends one request at a time. If received bytes are not
// clearly the response to this request, the link is closed.

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
#include "drivers/modbus/modbus_message.h"

struct _modbus;  // NOLINT(bugprone-reserved-identifier): the name in libmodbus

namespace softgrip::drivers {

/// Base class of the links. libmodbus receives the responses on a network. On a serial line, libmodbus opens
/// the device and sends the requests. This class adds three properties. Each wait ends at a time of
/// CLOCK_BOOTTIME [ns], and not after a pause between two bytes. Functions of this project check a received
/// frame before its contents are used. Bytes after a frame are detected. docs/explanation/libraries.md gives
/// the reasons.
///
/// A repeated request is an identical frame, so it writes the same output values as the first frame. The
/// repetition is sent within the deadline of the exchange and does not extend this deadline.
///
/// The constructors, open() of a serial line, cost() and describe() allocate memory; all other functions do
/// not. No function throws exceptions or resolves host names. LinkHabits::repeat_after_s determines if
/// requests are repeated.
class ModbusLink {
 public:
  ModbusLink(const ModbusLink&) = delete;
  ModbusLink& operator=(const ModbusLink&) = delete;
  ModbusLink(ModbusLink&&) = delete;
  ModbusLink& operator=(ModbusLink&&) = delete;
  virtual ~ModbusLink();

  /// Opens the link. If the link is already open, it is closed first.
  [[nodiscard]] BusStatus open(Nanoseconds deadline) noexcept;
  /// Waits until the settle time after open() is over. Bytes that arrive in this time are discarded.
  [[nodiscard]] BusStatus settle(Nanoseconds deadline) noexcept;
  void close() noexcept;
  [[nodiscard]] bool is_open() const noexcept { return descriptor() >= 0; }

  /// Sends a request and waits for the response. After the results `ok` and `exception`, the link remains
  /// open. After any other result, the link is closed. As a result, a late or duplicated reply cannot be
  /// taken for the response to a later request.
  [[nodiscard]] BusStatus ask(std::uint8_t unit, const ModbusRequest& request, Nanoseconds deadline) noexcept;
  /// Returns the data of the last successful ask(): bits or registers, high byte first. The data are valid
  /// until the next ask().
  [[nodiscard]] std::span<const std::uint8_t> data() const noexcept { return data_; }
  /// Returns the exception code if the last ask() returned `exception`; otherwise 0.
  [[nodiscard]] unsigned exception_code() const noexcept { return exception_code_; }
  /// Returns a text that gives the reason of the last failure.
  [[nodiscard]] const char* detail() const noexcept { return detail_.data(); }

  /// forget_measurements() deletes the measured round trips for cost(). keep_measurement() adds the round
  /// trip of the last ask() to the measurements.
  void forget_measurements() noexcept { measured_.reset(); }
  void keep_measurement() noexcept { measured_.add(answer_time(last_round_trip_)); }
  /// Returns the duration of `transactions` if they are executed one after the other, with an explanation of
  /// the calculation. The explanation contains `plan`, a description of the transactions.
  [[nodiscard]] virtual Board::Budget cost(std::span<const TransactionSize> transactions,
                                           const std::string& plan) const = 0;
  /// Returns the address of the link as text, for example "127.0.0.1:502" or "/dev/ttyUSB0 (115200 8N1)".
  [[nodiscard]] virtual std::string describe() const = 0;

 protected:
  /// Creates a closed link that owns the libmodbus context `context`. If `context` is null, open() fails.
  ModbusLink(_modbus* context, const LinkHabits& habits, bool on_network) noexcept;

  [[nodiscard]] _modbus* context() const noexcept { return context_; }
  [[nodiscard]] int descriptor() const noexcept;
  /// Stores the reason for a failure of the link, closes the link, and returns `status`.
  BusStatus refuse(BusStatus status, const char* what, const char* why) noexcept;
  /// Closes the link and returns `status`, as refuse() does. In addition, stores that a response may arrive
  /// on this link later.
  BusStatus fail(BusStatus status, const char* what, const char* why) noexcept;
  BusStatus wait_until_ready(short events, Nanoseconds deadline, const char* what) noexcept;
  /// Reads the available bytes of a link that is ready for reading.
  BusStatus read_some(std::span<std::uint8_t> bytes, const char* what, std::size_t& got) noexcept;
  /// Closes the link, because the board or gateway has closed the connection.
  BusStatus ended(const char* what) noexcept;
  /// Connects over TCP, and gives the socket to libmodbus.
  BusStatus connect_over_tcp(const TcpAddress& address, Nanoseconds deadline) noexcept;
  /// Sends a frame over TCP.
  BusStatus send_over_tcp(std::span<const std::uint8_t> frame) noexcept;
  [[nodiscard]] const RoundTrip& measured() const noexcept { return measured_; }

  /// Text that detail() returns if bytes have arrived although no request was waiting for a response.
  static constexpr const char* unasked = "unexpected bytes were received, possibly a late or repeated reply";

  /// A checked response. `error` is whole_frame for a complete frame. For an incomplete frame, `error` is the
  /// errno that gives the reason.
  struct Received {
    ModbusReply reply;
    int error = 0;
    std::span<const std::uint8_t> bytes = {};
  };
  static constexpr int whole_frame = 0;

  Descriptor held_;               ///< descriptor of the link, which is closed together with the link
  Nanoseconds heard_at_ = 0;      ///< time at which bytes were last received
  bool answer_may_come_ = false;  ///< true: a response to a request of the last session may still arrive

 private:
  virtual BusStatus connect(Nanoseconds deadline) noexcept = 0;
  /// Writes the frame of a request. Returns the size of the frame; 0 for a request that reply_pdu_size()
  /// refuses.
  virtual std::size_t build(std::uint8_t unit, const ModbusRequest& request, Frame& frame) noexcept = 0;
  /// Waits until the link permits to send a request.
  virtual BusStatus before_asking(Nanoseconds) noexcept { return BusStatus::ok; }
  virtual BusStatus send(std::span<const std::uint8_t> frame, Nanoseconds deadline) noexcept = 0;
  /// Checks `bytes`, which are all bytes that were received since the request `asked` was sent.
  [[nodiscard]] virtual ModbusReply judge(std::span<const std::uint8_t> bytes, std::uint8_t unit,
                                          const ModbusRequest& request,
                                          std::span<const std::uint8_t> asked) const noexcept = 0;
  /// Receives a response with libmodbus into `buffer`, which the caller has filled with the filler value.
  virtual Received hear(std::span<std::uint8_t> buffer, std::uint8_t unit, const ModbusRequest& request,
                        std::span<const std::uint8_t> asked, Nanoseconds deadline) noexcept;
  /// Returns the time for which the serial line still transmits a frame after send() has returned [ns]. The
  /// argument is the number of bytes in the frame. Returns 0 for a network.
  [[nodiscard]] virtual Nanoseconds sending_time(std::size_t) const noexcept { return 0; }
  /// numbers_answers() returns true if each response contains the transaction id of its request.
  /// answers_previous() returns true if the bytes begin with the transaction id of the previous request.
  [[nodiscard]] virtual bool numbers_answers() const noexcept { return false; }
  [[nodiscard]] virtual bool answers_previous(std::span<const std::uint8_t>) const noexcept { return false; }
  /// Returns the largest number of bytes before or after a response that are discarded. The number is smaller
  /// than the size of the shortest response. Therefore, the discarded bytes cannot be the response to another
  /// request.
  [[nodiscard]] virtual std::size_t most_stray() const noexcept { return 0; }
  /// Returns the index of the unit id in a frame.
  [[nodiscard]] virtual std::size_t unit_place() const noexcept = 0;
  /// Returns the part of a measured round trip that cost() uses.
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
  bool answered_ = false;  ///< true: a module has responded since the link was opened
  Nanoseconds first_asked_at_ = 0;
  Nanoseconds asked_at_ = 0;
  unsigned repeats_ = 0;         ///< number of repetitions of the last request
  unsigned stale_ = 0;           ///< number of late responses to repetitions of the previous request that may
                                 ///< still arrive
  Nanoseconds quiet_until_ = 0;  ///< end of the time in which late responses to the previous request may
                                 ///< arrive
  /// A descriptor below 1024 that is reserved for the link. libmodbus waits with select(), which does not
  /// accept descriptors above 1023.
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

// The following functions connect to a host within a deadline, and send frames without waiting. They do not
// allocate memory.

/// A connection, or the reason why the connection failed.
struct TcpConnection {
  Descriptor socket;
  BusStatus status = BusStatus::disconnected;
  const char* why = "";
};

/// Connects to an IPv4 or IPv6 address. Fails if the connection is not open at the time `deadline` of
/// CLOCK_BOOTTIME [ns].
[[nodiscard]] TcpConnection connect_tcp(const TcpAddress& to, Nanoseconds deadline) noexcept;

/// Sends a frame. Returns 0 if the complete frame was sent, otherwise the errno.
[[nodiscard]] int send_whole(int socket, std::span<const std::uint8_t> frame) noexcept;
/// Returns true if the errno `error` means that the peer has closed the connection.
[[nodiscard]] bool is_closed(int error) noexcept;

}  // namespace softgrip::drivers
