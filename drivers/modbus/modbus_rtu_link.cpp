#include "drivers/modbus/modbus_rtu_link.h"

#include <poll.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <exception>
#include <utility>

#include <modbus/modbus.h>

#include "base/clock.h"
#include "base/descriptor.h"
#include "base/periodic_schedule.h"
#include "base/text.h"
#include "base/time.h"

namespace softgrip::drivers {
namespace {

/// Assumed duration of a character on the serial line at 9600 baud [ns]. The actual baud rate is unknown.
constexpr Nanoseconds slow_character = 1'041'667;

}  // namespace

/// Discards late bytes of the previous session, because a module may still send a response to an old request.
/// Such a response may have the size of the longest frame. Returns after a silence on the line.
BusStatus ModbusRtuFraming::listen(Nanoseconds usual, Nanoseconds deadline) noexcept {
  heard_at_ = monotonic_now();
  if (!answer_may_come_) return BusStatus::ok;
  const Nanoseconds longest_frame = static_cast<Nanoseconds>(max_rtu_frame) * character_;
  Nanoseconds end = std::min(monotonic_now() + longest_frame + usual + silence_,
                             monotonic_now() + (deadline - monotonic_now()) / 2);
  while (monotonic_now() < end) {
    if (monotonic_now() >= deadline)
      return fail(BusStatus::bad_reply, "listening", "the line did not become idle before the deadline");
    const Waited waited = wait_for(descriptor(), POLLIN, std::min(end, deadline));
    if (waited == Waited::failed) return fail(BusStatus::disconnected, "listening", text_of_errno(errno));
    if (waited == Waited::timed_out) continue;
    std::array<std::uint8_t, max_rtu_frame> passing;
    std::size_t got = 0;
    const BusStatus status = read_some(passing, "listening", got);
    if (status != BusStatus::ok) return status;
    end = std::max(end, heard_at_ + silence_);
  }
  answer_may_come_ = false;
  return BusStatus::ok;
}

std::size_t ModbusRtuFraming::build(std::uint8_t unit, const ModbusRequest& request, Frame& frame) noexcept {
  last_size_ = size_of(request);
  return ::modbus_set_slave(context(), unit) == 0 ? build_rtu_request(request, unit, frame) : 0;
}

BusStatus ModbusRtuFraming::before_asking(Nanoseconds deadline) noexcept {
  for (std::size_t strays = 0;;) {
    const Nanoseconds quiet = heard_at_ + silence_;
    if (quiet > deadline) return fail(BusStatus::timed_out, "waiting for silence", "the deadline passed");
    if (quiet > monotonic_now()) sleep_until(quiet);
    pollfd line{.fd = descriptor(), .events = POLLIN, .revents = 0};
    if (::poll(&line, 1, 0) == 0) return BusStatus::ok;
    std::array<std::uint8_t, max_stray_bytes + 1> bytes{};
    std::size_t got = 0;
    const BusStatus status = read_some(bytes, "before asking", got);
    if (status != BusStatus::ok || got == 0) return status;
    strays += got;
    if (strays > max_stray_bytes) return fail(BusStatus::bad_reply, "before asking", unasked);
  }
}

/// Receives a response. Up to max_stray_bytes stray bytes may precede the response. Each read requests only
/// the number of bytes that are missing until the earliest possible end of the response.
ModbusLink::Received ModbusRtuFraming::hear(std::span<std::uint8_t> buffer, std::uint8_t unit,
                                            const ModbusRequest& request, std::span<const std::uint8_t> asked,
                                            Nanoseconds deadline) noexcept {
  constexpr std::size_t shortest = exception_pdu_size + rtu_overhead;
  const std::size_t whole = reply_pdu_size(request) + rtu_overhead;
  for (std::size_t got = 0;;) {
    const auto bytes = std::span<const std::uint8_t>(buffer).first(got);
    const ModbusReply first = judge(bytes, unit, request, asked);
    if (first.defect == ReplyDefect::own_echo) return {first, whole_frame, bytes};
    std::size_t missing = buffer.size();
    for (std::size_t strays = 0; strays <= std::min(max_stray_bytes, got); ++strays) {
      const ModbusReply reply = judge(bytes.subspan(strays), unit, request, asked);
      if (is_answer(reply)) return {reply, whole_frame, bytes};
      if (reply.state != ModbusReply::State::incomplete) continue;
      const std::size_t size = got < strays + shortest ? shortest : whole;
      missing = std::min(missing, strays + size - got);
    }
    if (got + missing > buffer.size()) return {first, whole_frame, bytes};
    const Waited waited = wait_for(descriptor(), POLLIN, deadline);
    if (waited != Waited::ready) return {first, waited == Waited::failed ? errno : ETIMEDOUT, bytes};
    const ssize_t count = ::read(descriptor(), &buffer[got], missing);
    if (count == 0) return {first, ECONNRESET, bytes};
    if (count < 0 && errno != EAGAIN && errno != EINTR) return {first, errno, bytes};
    got += static_cast<std::size_t>(std::max<ssize_t>(0, count));
    heard_at_ = monotonic_now();
  }
}

ModbusReply ModbusRtuFraming::judge(std::span<const std::uint8_t> bytes, std::uint8_t unit,
                                    const ModbusRequest& request,
                                    std::span<const std::uint8_t> asked) const noexcept {
  return parse_rtu_reply(bytes, request, unit, asked);
}

ModbusRtuLink::ModbusRtuLink(SerialLine line)
    : ModbusRtuFraming(new_context(line), line.habits, false, nanoseconds(character_s(line)),
                       nanoseconds(drivers::silence_s(line))),
      line_(std::move(line)) {}

BusStatus ModbusRtuLink::connect(Nanoseconds deadline) noexcept {
  std::optional<UnclearDevice> unclear;
  try {
    unclear = unclear_serial_device(line_.device);
  } catch (const std::exception& error) {
    return refuse(BusStatus::disconnected, "looking for the serial device", error.what());
  }
  if (unclear && unclear->several)
    return refuse(BusStatus::disconnected, unclear->message.c_str(), unclear->hint.c_str());
  const SerialFailure failure = open_serial(context(), line_, held_);
  if (failure.what != nullptr) {
    std::array<char, 128> what{};
    std::array<char, 128> why{};
    std::snprintf(what.data(), what.size(), "%s %s", failure.what, line_.device.c_str());
    std::snprintf(why.data(), why.size(), "%s%s%s",
                  failure.error != 0 ? text_of_errno(failure.error) : "refused", unclear ? "; " : "",
                  unclear ? unclear->hint.c_str() : "");
    return refuse(BusStatus::disconnected, what.data(), why.data());
  }
  return listen(nanoseconds(line_.turnaround_s + line_.adapter_latency_s), deadline);
}

BusStatus ModbusRtuLink::send(std::span<const std::uint8_t> frame, Nanoseconds deadline) noexcept {
  // libmodbus appends the checksum to the frame.
  const auto unchecked = static_cast<int>(frame.size()) - 2;
  if (::modbus_send_raw_request(context(), frame.data(), unchecked) != static_cast<int>(frame.size())) {
    return fail(BusStatus::disconnected, "sending", text_of_errno(errno < MODBUS_ENOBASE ? errno : ENOBUFS));
  }
  return line_.echo ? take_echo(frame, deadline) : BusStatus::ok;
}

BusStatus ModbusRtuLink::take_echo(std::span<const std::uint8_t> frame, Nanoseconds deadline) noexcept {
  std::array<std::uint8_t, max_rtu_frame> echo;
  while (!frame.empty()) {
    BusStatus status = wait_until_ready(POLLIN, deadline, "waiting for the echo of the request");
    std::size_t got = 0;
    if (status == BusStatus::ok) status = read_some(std::span(echo).first(frame.size()), "sending", got);
    if (status != BusStatus::ok) return status;
    if (!std::equal(echo.begin(), echo.begin() + static_cast<std::ptrdiff_t>(got), frame.begin())) {
      return fail(BusStatus::bad_reply, "sending",
                  "the echo differs from the sent bytes: a second client (master) may be on the line");
    }
    frame = frame.subspan(got);
  }
  return BusStatus::ok;
}

/// Returns the response time of module and adapter: the round trip minus the transmission time and one
/// silence. The silence is subtracted, because a module recognises the end of a request by the silence.
Nanoseconds ModbusRtuLink::answer_time(Nanoseconds round_trip) const noexcept {
  const auto bytes = static_cast<Nanoseconds>(last_size().request + last_size().reply + 2 * rtu_overhead);
  return std::max<Nanoseconds>(0, round_trip - bytes * character() - silence());
}

Board::Budget ModbusRtuLink::cost(std::span<const TransactionSize> transactions,
                                  const std::string& plan) const {
  const auto count = static_cast<double>(transactions.size());
  std::size_t bytes = 0;
  for (const TransactionSize& size : transactions) bytes += size.request + size.reply + 2 * rtu_overhead;
  const double wire_s = static_cast<double>(bytes) * character_s(line_);
  const double silences_s = 2 * count * seconds(silence());
  const bool known = measured().count() > 0;
  const double answer_s = known ? measured().median_s() : line_.turnaround_s + line_.adapter_latency_s;

  std::string source;
  if (known) {
    source = "median of " + std::to_string(measured().count()) +
             " response times measured when connecting, slowest " + milliseconds(measured().slowest_s());
  } else {
    source = "turnaround " + milliseconds(line_.turnaround_s) + " and adapter " +
             milliseconds(line_.adapter_latency_s) +
             ", not measured because the board has not been connected yet";
  }
  const auto number = [](std::size_t value) { return std::to_string(value); };
  Board::Budget cost;
  cost.exchange_s = wire_s + silences_s + count * answer_s;
  const auto product = [&](std::size_t times, double each_s) {
    return number(times) + " x " + milliseconds(each_s) + " = " +
           milliseconds(static_cast<double>(times) * each_s);
  };
  cost.explanation = format_of(line_) + ", " + plan + ": " + number(bytes) + " bytes (" +
                     milliseconds(wire_s) + ") + silences (" +
                     product(2 * transactions.size(), seconds(silence())) + ") + response times (" +
                     product(transactions.size(), answer_s) + "; " + source + ")";
  return cost;
}

std::string ModbusRtuLink::describe() const {
  return line_.device + " (" + format_of(line_) + ")";
}

// libmodbus gets a socket that is already open. Therefore, libmodbus never opens the device "/dev/null" of
// this context.
ModbusRtuTcpLink::ModbusRtuTcpLink(TcpAddress address)
    : ModbusRtuFraming(::modbus_new_rtu("/dev/null", 9600, 'N', 8, 1), address.habits, true, slow_character,
                       nanoseconds(address.silence_s)),
      address_(std::move(address)) {}

BusStatus ModbusRtuTcpLink::connect(Nanoseconds deadline) noexcept {
  const BusStatus status = connect_over_tcp(address_, deadline);
  return status == BusStatus::ok ? listen(0, deadline) : status;
}

BusStatus ModbusRtuTcpLink::send(std::span<const std::uint8_t> frame, Nanoseconds) noexcept {
  return send_over_tcp(frame);
}

Board::Budget ModbusRtuTcpLink::cost(std::span<const TransactionSize> transactions,
                                     const std::string& plan) const {
  Board::Budget cost = tcp_cost(transactions.size(), plan, address_.host, measured());
  const double silences_s = static_cast<double>(transactions.size()) * address_.silence_s;
  cost.exchange_s += silences_s;
  cost.explanation += ", RTU frames: the silences between frames take " + milliseconds(silences_s);
  return cost;
}

std::string ModbusRtuTcpLink::describe() const {
  return address_.host + ":" + std::to_string(address_.port) + " (RTU frames)";
}

}  // namespace softgrip::drivers
