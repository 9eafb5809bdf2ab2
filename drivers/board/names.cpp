// Defines the names that the enumeration values of drivers/ have in board files, events and messages.

#include "drivers/board/board.h"
#include "drivers/board/board_map.h"

namespace softgrip::drivers {

const char* name_of(BusStatus status) noexcept {
  switch (status) {
    case BusStatus::ok:
      return "ok";
    case BusStatus::disconnected:
      return "disconnected";
    case BusStatus::closed_at_once:
      return "closed_at_once";
    case BusStatus::timed_out:
      return "timed_out";
    case BusStatus::bad_reply:
      return "bad_reply";
    case BusStatus::exception:
      return "exception";
    case BusStatus::write_refused:
      return "write_refused";
    case BusStatus::overwritten:
      return "overwritten";
    case BusStatus::watchdog_tripped:
      return "watchdog_tripped";
  }
  return "unknown";
}

std::string_view name_of(RegisterKind kind) noexcept {
  switch (kind) {
    case RegisterKind::uint16:
      return "uint16";
    case RegisterKind::int16:
      return "int16";
    case RegisterKind::uint32:
      return "uint32";
    case RegisterKind::int32:
      return "int32";
    case RegisterKind::float32:
      return "float32";
  }
  return "unknown";
}

std::string_view name_of(WordOrder order) noexcept {
  switch (order) {
    case WordOrder::high_first:
      return "high_first";
    case WordOrder::low_first:
      return "low_first";
    case WordOrder::high_first_bytes_swapped:
      return "high_first_bytes_swapped";
    case WordOrder::low_first_bytes_swapped:
      return "low_first_bytes_swapped";
  }
  return "unknown";
}

std::string_view name_of(ElectricalUnit unit) noexcept {
  switch (unit) {
    case ElectricalUnit::volt:
      return "V";
    case ElectricalUnit::milliampere:
      return "mA";
    case ElectricalUnit::kilopascal:
      return "kPa";
  }
  return "unknown";
}

}  // namespace softgrip::drivers
