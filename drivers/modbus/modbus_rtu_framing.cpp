#include "drivers/modbus/modbus_rtu_framing.h"

#include <modbus/modbus.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "base/clock.h"
#include "base/descriptor.h"
#include "base/periodic_schedule.h"
#include "base/text.h"

namespace softgrip::drivers {

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

}  // namespace softgrip::drivers
