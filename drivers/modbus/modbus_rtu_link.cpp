#include "drivers/modbus/modbus_rtu_link.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <utility>

#include "base/clock.h"
#include "base/descriptor_wait.h"
#include "base/errno_text.h"
#include "drivers/modbus/exception_text.h"
#include "drivers/modbus/serial_port.h"

namespace softgrip::drivers {
namespace {

Nanoseconds now() noexcept {
  return MonotonicClock().now();
}

Nanoseconds nanoseconds(double seconds) noexcept {
  return std::llround(seconds * 1e9);
}

double seconds(Nanoseconds duration) noexcept {
  return static_cast<double>(duration) * 1e-9;
}

void sleep_until(Nanoseconds moment) noexcept {
  const timespec until{.tv_sec = moment / 1'000'000'000, .tv_nsec = moment % 1'000'000'000};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace

ModbusRtuLink::ModbusRtuLink(SerialLine line)
    : line_(std::move(line)),
      character_(nanoseconds(character_s(line_))),
      silence_(nanoseconds(drivers::silence_s(line_))) {}

ModbusRtuLink::~ModbusRtuLink() {
  if (port_ >= 0) ::close(port_);
}

void ModbusRtuLink::close() noexcept {
  if (port_ >= 0) ::close(port_);
  port_ = -1;
}

BusStatus ModbusRtuLink::fail(BusStatus status, const char* what, const char* why) noexcept {
  std::snprintf(detail_.data(), detail_.size(), "%s: %s", what, why);
  close();
  answer_may_come_ = true;
  return status;
}

BusStatus ModbusRtuLink::open(Nanoseconds deadline) noexcept {
  close();
  const SerialPort port = open_serial(line_);
  if (port.descriptor < 0) {
    std::snprintf(detail_.data(), detail_.size(), "%s %s: %s", port.what, line_.device.c_str(),
                  port.error != 0 ? text_of_errno(port.error) : "refused");
    return BusStatus::disconnected;
  }
  port_ = port.descriptor;
  silent_since_ = now();
  return answer_may_come_ ? listen(deadline) : BusStatus::ok;
}

/// Lets pass what still belongs to the session before: a module may be about to answer, and its answer may be
/// as long as a frame can be. Ends with silence.
BusStatus ModbusRtuLink::listen(Nanoseconds deadline) noexcept {
  const Nanoseconds longest_frame = static_cast<Nanoseconds>(max_rtu_frame) * character_;
  const Nanoseconds usual = nanoseconds(line_.turnaround_s + line_.adapter_latency_s);
  Nanoseconds end = std::min(now() + longest_frame + usual + silence_, now() + (deadline - now()) / 2);
  while (now() < end) {
    if (now() >= deadline) return fail(BusStatus::bad_reply, "listening", "the line does not fall silent");
    const Waited waited = wait_for(port_, POLLIN, std::min(end, deadline));
    if (waited == Waited::failed) return fail(BusStatus::disconnected, "listening", text_of_errno(errno));
    if (waited == Waited::timed_out) continue;
    const ssize_t got = ::read(port_, incoming_.data(), incoming_.size());
    if (got == 0) return fail(BusStatus::disconnected, "listening", "the device is gone");
    if (got < 0 && errno != EAGAIN && errno != EINTR) {
      return fail(BusStatus::disconnected, "listening", text_of_errno(errno));
    }
    silent_since_ = now();
    end = std::max(end, silent_since_ + silence_);
  }
  answer_may_come_ = false;
  return BusStatus::ok;
}

BusStatus ModbusRtuLink::wait_until_ready(short events, Nanoseconds deadline, const char* what) noexcept {
  switch (wait_for(port_, events, deadline)) {
    case Waited::ready:
      return BusStatus::ok;
    case Waited::timed_out:
      return fail(BusStatus::timed_out, what, "the deadline passed");
    case Waited::failed:
      break;
  }
  return fail(BusStatus::disconnected, what, text_of_errno(errno));
}

BusStatus ModbusRtuLink::wait_for_silence(Nanoseconds deadline) noexcept {
  const Nanoseconds quiet = silent_since_ + silence_;
  if (quiet > deadline) return fail(BusStatus::timed_out, "waiting for silence", "the deadline passed");
  if (quiet > now()) sleep_until(quiet);
  const ssize_t got = ::read(port_, incoming_.data(), incoming_.size());
  if (got > 0) {
    return fail(BusStatus::bad_reply, "before asking",
                "bytes came that nobody asked for, a late or repeated reply");
  }
  if (got == 0) return fail(BusStatus::disconnected, "before asking", "the device is gone");
  if (errno == EAGAIN || errno == EINTR) return BusStatus::ok;
  return fail(BusStatus::disconnected, "before asking", text_of_errno(errno));
}

BusStatus ModbusRtuLink::send_all(std::span<const std::uint8_t> frame, Nanoseconds deadline) noexcept {
  while (!frame.empty()) {
    const ssize_t sent = ::write(port_, frame.data(), frame.size());
    if (sent > 0) {
      frame = frame.subspan(static_cast<std::size_t>(sent));
    } else if (sent == 0 || errno == EAGAIN) {
      const BusStatus status = wait_until_ready(POLLOUT, deadline, "sending");
      if (status != BusStatus::ok) return status;
    } else if (errno != EINTR) {
      return fail(BusStatus::disconnected, "sending", text_of_errno(errno));
    }
  }
  return BusStatus::ok;
}

/// What the bytes received so far are; `over` is left false while more must come.
BusStatus ModbusRtuLink::judge(std::size_t have, std::uint8_t unit, const ModbusRequest& request,
                               std::span<const std::uint8_t> asked, bool& over) noexcept {
  std::span<const std::uint8_t> bytes = std::span<const std::uint8_t>(incoming_).first(have);
  if (line_.echo) {
    const std::size_t common = std::min(have, asked.size());
    if (!std::equal(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(common), asked.begin())) {
      return fail(BusStatus::bad_reply, "sending", "the echo is not what was sent: two masters on one line?");
    }
    bytes = bytes.subspan(common);
  }
  const ModbusReply reply = parse_rtu_reply(bytes, request, unit, asked);
  over = reply.state != ModbusReply::State::incomplete;
  switch (reply.state) {
    case ModbusReply::State::incomplete:
      return BusStatus::ok;
    case ModbusReply::State::complete:
      data_ = reply.data;
      return BusStatus::ok;
    case ModbusReply::State::exception:
      std::snprintf(detail_.data(), detail_.size(), "unit %u refused function %u at %u: %s (exception %u)",
                    static_cast<unsigned>(unit), static_cast<unsigned>(request.function),
                    static_cast<unsigned>(request.address), text_of_exception(reply.exception_code),
                    static_cast<unsigned>(reply.exception_code));
      return BusStatus::exception;
    case ModbusReply::State::defective:
      break;
  }
  return fail(BusStatus::bad_reply, "receiving", text_of(reply.defect));
}

BusStatus ModbusRtuLink::receive(std::uint8_t unit, const ModbusRequest& request,
                                 std::span<const std::uint8_t> asked, Nanoseconds deadline) noexcept {
  std::size_t have = 0;
  while (true) {
    const char* const what = have == 0 ? "waiting for the reply" : "waiting for the rest of the reply";
    if (const BusStatus status = wait_until_ready(POLLIN, deadline, what); status != BusStatus::ok) {
      return status;
    }
    const ssize_t got = ::read(port_, incoming_.data() + have, incoming_.size() - have);
    if (got == 0) return fail(BusStatus::disconnected, what, "the device is gone");
    if (got < 0) {
      if (errno == EINTR || errno == EAGAIN) continue;
      return fail(BusStatus::disconnected, what, text_of_errno(errno));
    }
    silent_since_ = now();
    have += static_cast<std::size_t>(got);
    bool over = false;
    const BusStatus status = judge(have, unit, request, asked, over);
    if (over || status != BusStatus::ok) return status;
  }
}

BusStatus ModbusRtuLink::ask(std::uint8_t unit, const ModbusRequest& request, Nanoseconds deadline) noexcept {
  data_ = {};
  if (!is_open()) return BusStatus::disconnected;
  const std::size_t size = build_rtu_request(request, unit, outgoing_);
  if (size == 0) return fail(BusStatus::bad_reply, "asking", "no such Modbus request");
  if (const BusStatus status = wait_for_silence(deadline); status != BusStatus::ok) return status;
  const auto frame = std::span<const std::uint8_t>(outgoing_).first(size);
  const Nanoseconds asked_at = now();
  if (const BusStatus status = send_all(frame, deadline); status != BusStatus::ok) return status;
  const BusStatus status = receive(unit, request, frame, deadline);
  last_round_trip_ = now() - asked_at;
  last_size_ = {size - rtu_overhead, reply_pdu_size(request)};
  return status;
}

Nanoseconds ModbusRtuLink::wire_time(TransactionSize size) const noexcept {
  return static_cast<Nanoseconds>(size.request + size.reply + 2 * rtu_overhead) * character_;
}

void ModbusRtuLink::keep_measurement() noexcept {
  // A module answers after a silence of its own, by which it knows that the question is over.
  answers_.add(std::max<Nanoseconds>(0, last_round_trip_ - wire_time(last_size_) - silence_));
}

Board::Budget ModbusRtuLink::cost(std::span<const TransactionSize> transactions,
                                  const std::string& plan) const {
  const auto count = static_cast<double>(transactions.size());
  std::size_t bytes = 0;
  for (const TransactionSize& size : transactions) bytes += size.request + size.reply + 2 * rtu_overhead;
  const double wire_s = static_cast<double>(bytes) * character_s(line_);
  const double silences_s = 2 * count * seconds(silence_);
  const bool known = answers_.count() > 0;
  const double answer_s = known ? answers_.median_s() : line_.turnaround_s + line_.adapter_latency_s;

  std::string source;
  if (known) {
    source = "median of " + std::to_string(answers_.count()) + " measured when connecting, slowest " +
             milliseconds(answers_.slowest_s());
  } else {
    source = "turnaround " + milliseconds(line_.turnaround_s) + " and adapter " +
             milliseconds(line_.adapter_latency_s) + ", not measured: not connected yet";
  }
  const auto number = [](std::size_t value) { return std::to_string(value); };
  Board::Budget cost;
  cost.exchange_s = wire_s + silences_s + count * answer_s;
  cost.explanation = format_of(line_) + ", " + plan + ": " + number(bytes) + " bytes " +
                     milliseconds(wire_s) + " + " + number(2 * transactions.size()) + " silences of " +
                     milliseconds(seconds(silence_)) + " " + milliseconds(silences_s) + " + " +
                     number(transactions.size()) + (transactions.size() == 1 ? " answer" : " answers") +
                     " of " + milliseconds(answer_s) + " (" + source + ")";
  return cost;
}

std::string ModbusRtuLink::describe() const {
  return line_.device + " (" + format_of(line_) + ")";
}

}  // namespace softgrip::drivers
