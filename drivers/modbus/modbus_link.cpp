#include "drivers/modbus/modbus_link.h"

#include <fcntl.h>
#include <modbus/modbus.h>
#include <sys/ioctl.h>
#include <sys/select.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>

#include "base/clock.h"
#include "base/descriptor_wait.h"
#include "base/errno_text.h"
#include "drivers/modbus/exception_text.h"
#include "drivers/modbus/modbus_rtu_link.h"
#include "drivers/modbus/modbus_tcp_link.h"

namespace softgrip::drivers {
namespace {

static_assert(MODBUS_MAX_ADU_LENGTH <= max_frame);

// When a reply breaks off libmodbus does not tell how much of it came. What is still filler behind the last
// byte that is not did not come, or cannot be told from it: of a wrong beginning less is judged then.
constexpr std::uint8_t filler = 0xff;

constexpr int whole_frame = 0;  // in the place of an errno

Descriptor selectable_descriptor() noexcept {
  Descriptor place(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  return place.get() < FD_SETSIZE ? std::move(place) : Descriptor();
}

std::span<const std::uint8_t> without_filler(std::span<const std::uint8_t> bytes) noexcept {
  while (!bytes.empty() && bytes.back() == filler) bytes = bytes.first(bytes.size() - 1);
  return bytes;
}

bool more_came(int descriptor) noexcept {
  int waiting = 0;
  return ::ioctl(descriptor, FIONREAD, &waiting) == 0 && waiting > 0;
}

/// With a byte time-out of 0 libmodbus' response time-out ends the whole reply.
void set_deadline(modbus_t* context, Nanoseconds left) noexcept {
  const auto microseconds = static_cast<std::uint64_t>((left + 999) / 1000);
  ::modbus_set_response_timeout(context, static_cast<std::uint32_t>(microseconds / 1'000'000),
                                static_cast<std::uint32_t>(microseconds % 1'000'000));
}

}  // namespace

ModbusLink::ModbusLink(_modbus* context) noexcept : context_(context), place_(selectable_descriptor()) {
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
    return refuse(BusStatus::disconnected, "connecting", "libmodbus takes no such address");
  const BusStatus status = connect(deadline);
  if (status != BusStatus::ok) return status;
  if (put_where_select_finds_it()) return BusStatus::ok;
  return fail(BusStatus::disconnected, "connecting", "every descriptor below 1024 is taken");
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
  if (!is_open()) return BusStatus::disconnected;
  const std::size_t size = build(unit, request, outgoing_);
  if (size == 0) return fail(BusStatus::bad_reply, "asking", "no such Modbus request");
  const auto frame = std::span<const std::uint8_t>(outgoing_).first(size);
  if (const BusStatus status = before_asking(deadline); status != BusStatus::ok) return status;
  const Nanoseconds asked_at = monotonic_now();
  if (const BusStatus status = send(frame, deadline); status != BusStatus::ok) return status;
  int error = whole_frame;
  const ModbusReply reply = receive(unit, request, frame, deadline, error);
  last_round_trip_ = heard_at_ - asked_at;
  return conclude(reply, error, unit, request);
}

/// What came, judged; `error` says why it may be less than a frame.
ModbusReply ModbusLink::receive(std::uint8_t unit, const ModbusRequest& request,
                                std::span<const std::uint8_t> asked, Nanoseconds deadline,
                                int& error) noexcept {
  incoming_.fill(filler);
  const Nanoseconds left = deadline - monotonic_now();
  int size = -1;
  errno = ETIMEDOUT;
  if (left > 0) {
    set_deadline(context_, left);
    size = ::modbus_receive_confirmation(context_, incoming_.data());
  }
  error = size > 0 ? whole_frame : size == 0 ? EMBBADSLAVE : errno;
  heard_at_ = monotonic_now();
  const auto bytes = std::span<const std::uint8_t>(incoming_);
  const ModbusReply reply = judge(
      size > 0 ? bytes.first(static_cast<std::size_t>(size)) : without_filler(bytes), unit, request, asked);
  const bool answers =
      reply.state == ModbusReply::State::complete || reply.state == ModbusReply::State::exception;
  return answers && more_came(descriptor()) ? defective(ReplyDefect::trailing) : reply;
}

/// A reply that broke off.
BusStatus ModbusLink::name_failure(int error) noexcept {
  const bool began = !without_filler(incoming_).empty();
  const char* const what = began ? "waiting for the rest of the reply" : "waiting for the reply";
  switch (error) {
    case ETIMEDOUT:
      return fail(BusStatus::timed_out, what, "the deadline passed");
    case ECONNRESET:
      return fail(BusStatus::disconnected, what, "the other end is gone");
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
  if (reply.state == ModbusReply::State::defective) {
    return fail(BusStatus::bad_reply, "receiving", text_of(reply.defect));
  }
  if (error != whole_frame || reply.state == ModbusReply::State::incomplete) return name_failure(error);
  if (reply.state == ModbusReply::State::complete) {
    data_ = reply.data;
    return BusStatus::ok;
  }
  std::snprintf(detail_.data(), detail_.size(), "unit %u refused function %u at %u: %s (exception %u)",
                static_cast<unsigned>(unit), static_cast<unsigned>(request.function),
                static_cast<unsigned>(request.address), text_of_exception(reply.exception_code),
                static_cast<unsigned>(reply.exception_code));
  return BusStatus::exception;
}

std::unique_ptr<ModbusLink> make_link(const ModbusAddress& address) {
  if (const auto* tcp = std::get_if<TcpAddress>(&address)) return std::make_unique<ModbusTcpLink>(*tcp);
  return std::make_unique<ModbusRtuLink>(std::get<SerialLine>(address));
}

}  // namespace softgrip::drivers
