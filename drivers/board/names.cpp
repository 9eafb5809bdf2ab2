// Defines the names that the enumeration values of drivers/ have in events and messages.

#include "base/enum_table.h"
#include "drivers/board/board.h"
#include "drivers/board/board_map.h"

namespace softgrip::drivers {

namespace {
constexpr auto status_names = enum_names<BusStatus>({{BusStatus::ok, "ok"},
                                                     {BusStatus::disconnected, "disconnected"},
                                                     {BusStatus::timed_out, "timed_out"},
                                                     {BusStatus::bad_reply, "bad_reply"},
                                                     {BusStatus::exception, "exception"},
                                                     {BusStatus::write_refused, "write_refused"},
                                                     {BusStatus::overwritten, "overwritten"},
                                                     {BusStatus::watchdog_tripped, "watchdog_tripped"},
                                                     {BusStatus::closed_at_once, "closed_at_once"}});
constexpr auto unit_names = enum_names<ElectricalUnit>(
    {{ElectricalUnit::volt, "V"}, {ElectricalUnit::milliampere, "mA"}, {ElectricalUnit::kilopascal, "kPa"}});
}  // namespace

std::string_view name_of(BusStatus status) noexcept {
  return status_names[status];
}

std::string_view name_of(ElectricalUnit unit) noexcept {
  return unit_names[unit];
}

}  // namespace softgrip::drivers
