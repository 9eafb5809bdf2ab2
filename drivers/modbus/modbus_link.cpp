#include "drivers/modbus/modbus_link.h"

#include <fcntl.h>
#include <modbus/modbus.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/select.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>

#include "base/clock.h"
#include "base/text.h"
#include "base/time.h"
#include "drivers/modbus/modbus_rtu_link.h"
#include "drivers/modbus/modbus_tcp_link.h"

namespace softgrip::drivers {
namespace {

static_assert(MODBUS_MAX_ADU_LENGTH <= max_frame);

// After an incomplete reply, libmodbus does not report the number of received bytes. Therefore, the buffer is
// filled with this value before each reception. The bytes at the end of the buffer that have this value after
// the reception count as not received.
constexpr std::uint8_t filler = 0xff;

Descriptor selectable_descriptor() noexcept {
  Descriptor place(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  return place.get() < FD_SETSIZE ? std::move(place) : Descriptor();
}

std::span<const std::uint8_t> without_filler(std::span<const std::uint8_t> bytes) noexcept {
  while (!bytes.empty() && bytes.back() == filler) bytes = bytes.first(bytes.size() - 1);
  return bytes;
}

/// Sets the response time-out of libmodbus. The byte time-out of libmodbus is set to 0. Therefore, the
/// response time-out limits the duration of the complete reply.
void set_deadline(modbus_t* context, Nanoseconds left) noexcept {
  const auto microseconds = static_cast<std::uint64_t>((left + 999) / 1000);
  ::modbus_set_response_timeout(context, static_cast<std::uint32_t>(microseconds / 1'000'000),
                                static_cast<std::uint32_t>(microseconds % 1'000'000));
}

}  // namespace

ModbusLink::ModbusLink(_modbus* context, const LinkHabits& habits, bool on_network) noexcept
    : context_(context),
      on_network_(on_network),
      settle_(nanoseconds(habits.settle_s)),
      repeat_after_(nanoseconds(habits.repeat_after_s)),
      place_(selectable_descriptor()) {
  ::modbus_set_byte_timeout(context_, 0, 0);
}

ModbusLink::~ModbusLink() {
  close();
  if (context_ != nullptr) ::modbus_free(context_);
}

int ModbusLink::descriptor() const noexcept {
  return context_ == nullptr ? -1 : ::modbus_get_socket(context_);
}

BusStatus ModbusLink::open(Nanoseconds deadline) noexcept {
  close();
  if (context_ == nullptr)
    return refuse(BusStatus::disconnected, "connecting", "libmodbus does not accept the address");
  answered_ = false;
  repeats_ = 0;
  expect_more_answers();
  const BusStatus status = connect(deadline);
  if (status != BusStatus::ok) return status;
  opened_at_ = monotonic_now();
  if (put_where_select_finds_it()) return BusStatus::ok;
  return fail(BusStatus::disconnected, "connecting", "all file descriptors below 1024 are in use");
}

BusStatus ModbusLink::settle(Nanoseconds deadline) noexcept {
  return drain(opened_at_ + settle_, deadline, "waiting for settle_s after opening the connection");
}

/// Discards all bytes that arrive until the time `until`. If the link fails before this time, the function
/// closes the link and returns the status of the failure.
BusStatus ModbusLink::drain(Nanoseconds until, Nanoseconds deadline, const char* what) noexcept {
  while (monotonic_now() < until) {
    if (monotonic_now() >= deadline) return fail(BusStatus::timed_out, what, "the deadline passed");
    const Waited waited = wait_for(descriptor(), POLLIN, std::min(until, deadline));
    if (waited == Waited::failed) return fail(BusStatus::disconnected, what, text_of_errno(errno));
    if (waited == Waited::timed_out) continue;
    std::size_t got = 0;
    const BusStatus status = read_some(incoming_, what, got);
    if (status != BusStatus::ok) return status;
  }
  return BusStatus::ok;
}

BusStatus ModbusLink::connect_over_tcp(const TcpAddress& address, Nanoseconds deadline) noexcept {
  TcpConnection made = connect_tcp(address, deadline);
  if (!made.socket) return refuse(made.status, "connecting", made.why);
  ::modbus_set_socket(context_, made.socket.release());
  return BusStatus::ok;
}

BusStatus ModbusLink::send_over_tcp(std::span<const std::uint8_t> frame) noexcept {
  const int error = send_whole(descriptor(), frame);
  if (error == 0) return BusStatus::ok;
  return is_closed(error) ? ended("sending") : fail(BusStatus::disconnected, "sending", text_of_errno(error));
}

/// Closes the link after the board or gateway has closed the connection. A board that already serves its
/// largest number of clients may accept a connection and close it at once. If the connection ends before the
/// first response, the status is `closed_at_once`. This status shows that cable and address are right.
BusStatus ModbusLink::ended(const char* what) noexcept {
  if (!on_network_) return fail(BusStatus::disconnected, what, "the serial device no longer exists");
  if (answered_) return fail(BusStatus::disconnected, what, "the board or gateway closed the connection");
  return fail(BusStatus::closed_at_once, what,
              "the board accepted the connection but closed it before the first response, so it may accept "
              "no further client");
}

BusStatus ModbusLink::read_some(std::span<std::uint8_t> bytes, const char* what, std::size_t& got) noexcept {
  const ssize_t count = ::read(descriptor(), bytes.data(), bytes.size());
  if (count == 0 || (count < 0 && errno == ECONNRESET)) return ended(what);
  if (count < 0 && errno != EAGAIN && errno != EINTR) {
    return fail(BusStatus::disconnected, what, text_of_errno(errno));
  }
  got = static_cast<std::size_t>(std::max<ssize_t>(0, count));
  heard_at_ = monotonic_now();
  return BusStatus::ok;
}

bool ModbusLink::put_where_select_finds_it() noexcept {
  const int opened = descriptor();
  if (opened < FD_SETSIZE) return true;
  if (!place_ || ::dup3(opened, place_.get(), O_CLOEXEC) < 0) return false;
  ::close(opened);
  ::modbus_set_socket(context_, place_.release());
  return true;
}

void ModbusLink::close() noexcept {
  if (is_open()) ::modbus_close(context_);
  held_.reset();
  if (!place_) place_ = selectable_descriptor();
}

BusStatus ModbusLink::refuse(BusStatus status, const char* what, const char* why) noexcept {
  std::snprintf(detail_.data(), detail_.size(), "%s: %s", what, why);
  close();
  return status;
}

BusStatus ModbusLink::fail(BusStatus status, const char* what, const char* why) noexcept {
  answer_may_come_ = true;
  return refuse(status, what, why);
}

BusStatus ModbusLink::wait_until_ready(short events, Nanoseconds deadline, const char* what) noexcept {
  switch (wait_for(descriptor(), events, deadline)) {
    case Waited::ready:
      return BusStatus::ok;
    case Waited::timed_out:
      return fail(BusStatus::timed_out, what, "the deadline passed");
    case Waited::failed:
      break;
  }
  return fail(BusStatus::disconnected, what, text_of_errno(errno));
}

BusStatus ModbusLink::ask(std::uint8_t unit, const ModbusRequest& request, Nanoseconds deadline) noexcept {
  data_ = {};
  exception_code_ = 0;
  if (!is_open()) return BusStatus::disconnected;
  const std::size_t size = build(unit, request, outgoing_);
  if (size == 0) return fail(BusStatus::bad_reply, "sending", "the request is not a valid Modbus request");
  const auto frame = std::span<const std::uint8_t>(outgoing_).first(size);
  BusStatus status =
      drain(quiet_until_, deadline, "waiting for a possible second reply to a repeated request");
  if (status == BusStatus::ok) status = before_asking(deadline);
  if (status == BusStatus::ok) status = send_until_heard(frame, deadline);
  if (status != BusStatus::ok) return status;
  int error = whole_frame;
  const ModbusReply reply = receive(unit, request, frame, deadline, error);
  last_round_trip_ = heard_at_ - asked_at_;
  return conclude(reply, error, unit, request);
}

/// Sends the request, and repeats the request until a byte of a response arrives or the deadline passes.
BusStatus ModbusLink::send_until_heard(std::span<const std::uint8_t> frame, Nanoseconds deadline) noexcept {
  first_asked_at_ = monotonic_now();
  for (repeats_ = 0;; ++repeats_) {
    asked_at_ = monotonic_now();
    // A request must not be sent after its deadline. If the process was paused, the board's watchdog may have
    // vented the fingers. An old request would then move the fingers.
    if (asked_at_ >= deadline)
      return fail(BusStatus::timed_out, "before sending the request", "the deadline passed");
    if (const BusStatus status = send(frame, deadline); status != BusStatus::ok) return status;
    const Nanoseconds again = monotonic_now() + sending_time(frame.size()) + repeat_after_;
    if (repeat_after_ == 0 || again >= deadline) return BusStatus::ok;
    const Waited waited = wait_for(descriptor(), POLLIN, again);
    if (waited == Waited::ready) return BusStatus::ok;
    if (waited == Waited::failed)
      return fail(BusStatus::disconnected, "waiting for the reply", text_of_errno(errno));
  }
}

/// Stores that each repetition of the last request may still get a response of its own. A late response with
/// a transaction id is recognised when it arrives. A late response without a transaction id could be taken
/// for the response to the next request. Therefore, without transaction ids, the next request is delayed
/// until the late responses should have arrived.
void ModbusLink::expect_more_answers() noexcept {
  stale_ = repeats_;
  const bool quiet = repeats_ > 0 && !numbers_answers();
  quiet_until_ = quiet ? heard_at_ + (heard_at_ - first_asked_at_) : 0;
}

ModbusLink::Received ModbusLink::hear(std::span<std::uint8_t> buffer, std::uint8_t unit,
                                      const ModbusRequest& request, std::span<const std::uint8_t> asked,
                                      Nanoseconds deadline) noexcept {
  const Nanoseconds left = deadline - monotonic_now();
  int size = -1;
  errno = ETIMEDOUT;
  if (left > 0) {
    set_deadline(context_, left);
    size = ::modbus_receive_confirmation(context_, buffer.data());
  }
  const int error = size > 0 ? whole_frame : size == 0 ? EMBBADSLAVE : errno;
  heard_at_ = monotonic_now();
  const auto bytes = size > 0 ? std::span<const std::uint8_t>(buffer).first(static_cast<std::size_t>(size))
                              : without_filler(buffer);
  return {judge(bytes, unit, request, asked), error, bytes};
}

/// Receives a response and checks it. Sets `error` to whole_frame if the frame is complete, otherwise to the
/// reason why the frame is incomplete.
ModbusReply ModbusLink::receive(std::uint8_t unit, const ModbusRequest& request,
                                std::span<const std::uint8_t> asked, Nanoseconds deadline,
                                int& error) noexcept {
  Received heard;
  for (bool old = true; old;) {
    incoming_.fill(filler);
    heard = hear(incoming_, unit, request, asked, deadline);
    old = heard.reply.defect == ReplyDefect::transaction && stale_ > 0 && answers_previous(heard.bytes);
    if (old) --stale_;
  }
  error = heard.error;
  // After a repeated request, bytes that follow the first response may be a second response.
  const bool alone = repeats_ > 0 || !is_answer(heard.reply) || drop_strays();
  return alone ? heard.reply : defective(ReplyDefect::trailing);
}

/// Discards the bytes that follow the response. Returns false if these bytes may be a second response.
bool ModbusLink::drop_strays() noexcept {
  int waiting = 0;
  if (::ioctl(descriptor(), FIONREAD, &waiting) != 0 || waiting <= 0) return true;
  const auto count = static_cast<std::size_t>(waiting);
  std::array<std::uint8_t, 8> strays;
  return count <= std::min(most_stray(), strays.size()) &&
         ::read(descriptor(), strays.data(), count) == static_cast<ssize_t>(count);
}

/// Closes the link after an incomplete reply. Returns the status that corresponds to the reason `error`.
BusStatus ModbusLink::name_failure(int error) noexcept {
  const bool began = !without_filler(incoming_).empty();
  const char* const what = began ? "waiting for the rest of the reply" : "waiting for the reply";
  switch (error) {
    case ETIMEDOUT:
      return fail(BusStatus::timed_out, what, "the deadline passed");
    case ECONNRESET:
      return ended(what);
    case EMBBADCRC:
      return fail(BusStatus::bad_reply, "receiving", text_of(ReplyDefect::checksum));
    default:
      break;
  }
  if (error != whole_frame && error < MODBUS_ENOBASE) {
    return fail(BusStatus::disconnected, what, text_of_errno(error));
  }
  return fail(BusStatus::bad_reply, "receiving", text_of(ReplyDefect::length));
}

BusStatus ModbusLink::conclude(const ModbusReply& reply, int error, std::uint8_t unit,
                               const ModbusRequest& request) noexcept {
  if (reply.state == ModbusReply::State::defective && reply.defect == ReplyDefect::unit) {
    std::array<char, 64> who{};
    std::snprintf(who.data(), who.size(), "%s: %u instead of %u", text_of(reply.defect),
                  static_cast<unsigned>(incoming_[unit_place()]), static_cast<unsigned>(unit));
    return fail(BusStatus::bad_reply, "receiving", who.data());
  }
  if (reply.state == ModbusReply::State::defective) {
    return fail(BusStatus::bad_reply, "receiving", text_of(reply.defect));
  }
  if (error != whole_frame || reply.state == ModbusReply::State::incomplete) return name_failure(error);
  answered_ = true;
  expect_more_answers();
  if (reply.state == ModbusReply::State::complete) {
    data_ = reply.data;
    return BusStatus::ok;
  }
  exception_code_ = reply.exception_code;
  std::snprintf(detail_.data(), detail_.size(),
                "unit %u refused function %u at address %u: %s (exception %u)", static_cast<unsigned>(unit),
                static_cast<unsigned>(request.function), static_cast<unsigned>(request.address),
                text_of_exception(reply.exception_code), static_cast<unsigned>(reply.exception_code));
  return BusStatus::exception;
}

std::unique_ptr<ModbusLink> make_link(const ModbusAddress& address) {
  if (const auto* tcp = std::get_if<TcpAddress>(&address)) {
    if (tcp->rtu_framing) return std::make_unique<ModbusRtuTcpLink>(*tcp);
    return std::make_unique<ModbusTcpLink>(*tcp);
  }
  return std::make_unique<ModbusRtuLink>(std::get<SerialLine>(address));
}

}  // namespace softgrip::drivers
