#include "tools/commissioning/examinations.h"

#include <algorithm>
#include <array>

#include "drivers/board/board.h"

namespace softgrip::tools::doctor {
namespace {

using drivers::BusStatus;

struct BusAdvice {
  BusStatus status;
  std::string_view text;
};

constexpr std::array<BusAdvice, 5> bus_advices{{
    {BusStatus::disconnected,
     "check the power and the cable of the board, and the address in the rig file; check that no other "
     "Modbus client occupies the board"},
    {BusStatus::closed_at_once,
     "the board is reachable but accepts no further client: end the other programs that are connected to the "
     "board, or wait until the board drops a broken connection"},
    {BusStatus::timed_out,
     "check power and cable of the board and `unit` in the rig file; a board that ignores the first requests "
     "after a connection needs `settle_s`"},
    {BusStatus::bad_reply,
     "check for another Modbus client or a gateway that mixes up responses; check `unit` in the rig file"},
    {BusStatus::exception,
     "the board responds but rejects the request: compare the function code, address and count in the board "
     "map with the manual of the board"},
}};

}  // namespace

std::string_view bus_advice(std::string_view failure_kind) noexcept {
  const auto* const found = std::find_if(
      bus_advices.begin(), bus_advices.end(),
      [failure_kind](const BusAdvice& advice) { return drivers::name_of(advice.status) == failure_kind; });
  return found == bus_advices.end() ? bus_advices.front().text : found->text;
}

}  // namespace softgrip::tools::doctor
