#include "control/elements/fault.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "base/enum_table.h"

namespace softgrip::control {

namespace {

constexpr FaultInfo no_fault{FaultCode::none, "F000", "none", "No fault.", "", "", ""};

constexpr std::array faults{
    FaultInfo{FaultCode::bus_down, "F101", "bus_down", "The daemon cannot communicate with the board.",
              "cable, switch, power of the board, address in the rig file",
              "Restore the connection; the daemon reconnects by itself.", "bus_down_cycles"},
    FaultInfo{FaultCode::bus_timed_out, "F102", "bus_timed_out",
              "The board did not respond within the deadline.",
              "rate_hz too high for the bus, busy board, wrong unit id on a serial line",
              "Lower rate_hz below the bus budget printed at start-up.", "bus_down_cycles"},
    FaultInfo{
        FaultCode::bus_bad_reply, "F103", "bus_bad_reply",
        "The response did not match the request (unit id, length, transaction, function).",
        "two Modbus clients on one line, a gateway that mixes responses, a wrong address",
        "The text of the event names the field that does not match. Disconnect any second Modbus client.",
        "bus_down_cycles"},
    FaultInfo{FaultCode::bus_exception, "F104", "bus_exception",
              "The board responded with a Modbus exception.",
              "a register or function that this board does not have",
              "Compare the board map with the manual of the board.", "bus_down_cycles"},
    FaultInfo{FaultCode::reading_stale, "F201", "reading_stale",
              "No new reading of a channel arrived within max_age_s.",
              "a bus slower than the control loop, a board that repeats old values",
              "Compare the reading age in `softgrip status` with max_age_s.", "invalid_reading_cycles + 1"},
    FaultInfo{FaultCode::reading_out_of_range, "F202", "reading_out_of_range",
              "The displacement signal was outside the electrical range of the sensor.",
              "target outside the measuring distance of the sensor, broken wire, wrong scaling",
              "Read the display of the sensor; measure the electrical signal of the sensor.",
              "invalid_reading_cycles + 1"},
    FaultInfo{FaultCode::sensor_error, "F203", "sensor_error", "The sensor or the board reported an error.",
              "no target in the view of the sensor, dirty sensor window, error of the input card",
              "Read the display of the sensor.", "invalid_reading_cycles + 1"},
    FaultInfo{FaultCode::reading_jumped, "F204", "reading_jumped",
              "The reading changed faster than a finger can move.",
              "an object in the beam of the sensor, loose sensor mount, electrical disturbance",
              "Clear the beam of the sensor; check the mount and the shield of the sensor.",
              "invalid_reading_cycles + 1 cycles; if unsteady_is_fault is true, also after 1 s of readings "
              "that jump back and forth"},
    FaultInfo{FaultCode::reading_frozen, "F205", "reading_frozen",
              "The reading stayed constant while the command changed.",
              "sensor in hold mode, blocked sensor beam, kinked air line, no supply pressure",
              "Move the finger by hand and check that the reading changes; check the supply pressure.",
              "invalid_reading_cycles + 1"},
    FaultInfo{FaultCode::displacement_beyond_limits, "F206", "displacement_beyond_limits",
              "A valid reading was outside the displacement limits by more than displacement_margin_mm.",
              "finger pushed aside or torn off, sensor moved, displacement limits too narrow",
              "Inspect the finger; compare the reading at rest with the displacement limits.",
              "displacement_cycles + 1"},
    FaultInfo{FaultCode::pressure_not_followed, "F207", "pressure_not_followed",
              "The measured pressure does not follow the command.",
              "burst or kinked air line, leak, no supply pressure, a valve without power",
              "Find the leak; check supply, valve and pressure sensor.",
              "pressure_cycles cycles in which the measured pressure is outside the range of the commands of "
              "the last pressure_delay_s by more than pressure_tolerance_kpa"},
    FaultInfo{FaultCode::pressure_invalid, "F208", "pressure_invalid",
              "The signal of the pressure monitor was not valid.",
              "broken wire, pressure monitor without power, wrong scaling",
              "Measure the electrical signal of the pressure monitor. Without a working pressure monitor, a "
              "burst line and a part lost by pressure are not detected.",
              "invalid_reading_cycles"},
    FaultInfo{FaultCode::readback_mismatch, "F301", "readback_mismatch",
              "The board's output differs from the written value.",
              "another Modbus client, a board in manual mode, a wrong scaling of the output",
              "Read the output register with another Modbus client.",
              "readback_cycles cycles in which the output is outside the range of the commands of the last "
              "readback_delay_s by more than readback_tolerance_kpa"},
    FaultInfo{FaultCode::write_refused, "F302", "write_refused", "The board rejected the write.",
              "an output in locked or manual mode, a latched watchdog trip of the board",
              "Clear the watchdog trip on the board.", "1 cycle"},
    FaultInfo{FaultCode::board_watchdog_tripped, "F303", "board_watchdog_tripped",
              "The board's own watchdog holds the outputs at their safe value.",
              "communication was interrupted for longer than the watchdog time of the board",
              "Find the communication gap in the recording; clear the watchdog trip on the board.",
              "1 cycle"},
    FaultInfo{
        FaultCode::outputs_overwritten, "F304", "outputs_overwritten",
        "The outputs changed without a write from softgripd: another Modbus client writes to the board.",
        "another client on the line or the network, for example a Modbus tool or a PLC",
        "Disconnect the other Modbus client. The outputs are vented.",
        "8 exchanges with the board; the board must permit reading back its outputs"},
    FaultInfo{FaultCode::model_unfit, "F401", "model_unfit",
              "The model in use no longer describes the finger.",
              "wear of the finger, a replaced finger, a leak, a moved sensor",
              "Record the test signal tp1 and identify the model again.",
              "1 cycle after the model status becomes unfit, if model_unfit_is_fault is true"},
    FaultInfo{FaultCode::emergency_stop, "F501", "emergency_stop",
              "The emergency stop is pressed, or has not been released since start-up.",
              "the emergency stop was pressed; the wire of the emergency stop is broken; the daemon was "
              "started on a rig with an emergency stop",
              "Make the area safe, release the emergency stop.",
              "1 cycle after the debounce time (debounce_s) of the input"},
    FaultInfo{FaultCode::inputs_lost, "F502", "inputs_lost", "The digital inputs cannot be read.",
              "the USB or expander chip was removed; the computer is too busy to read the inputs",
              "Reconnect the chip and restart the daemon. If the computer is too busy, raise stale_after_s.",
              "stale_after_s + 1 cycle"},
    FaultInfo{FaultCode::cycles_lost, "F901", "cycles_lost",
              "The control loop missed more consecutive cycles than allowed.",
              "no real-time scheduling, an overloaded computer",
              "Check the start-up report and the loop statistics.",
              "max_missed_commands exchanges without a new command from the control loop; if overrun_cycles "
              "is not 0, also overrun_cycles consecutive missed cycles + 1 cycle"},
    FaultInfo{FaultCode::not_finite, "F902", "not_finite", "A computed command was not a finite number.",
              "a model or controller gains that diverge",
              "Keep the recording; the cause is a software defect or an unusable model.", "1 cycle"},
};

/// Returns the number of enumerators of FaultCode whose numbers have up to three digits.
template <std::size_t... number>
consteval std::size_t count_codes(std::index_sequence<number...>) {
  constexpr std::array<bool, sizeof...(number)> declared{is_enumerator<static_cast<FaultCode>(number)>()...};
  return static_cast<std::size_t>(std::count(declared.begin(), declared.end(), true));
}

/// Returns true if each fault except `none` has one row, and if the rows are in the order of the codes.
consteval bool complete() {
  const auto later = [](const FaultInfo& a, const FaultInfo& b) { return a.code >= b.code; };
  return std::adjacent_find(faults.begin(), faults.end(), later) == faults.end() &&
         count_codes(std::make_index_sequence<1000>()) == faults.size() + 1;
}
static_assert(complete());

}  // namespace

std::span<const FaultInfo> all_faults() noexcept {
  return faults;
}

const FaultInfo& info_of(FaultCode code) noexcept {
  for (const FaultInfo& info : faults) {
    if (info.code == code) return info;
  }
  return no_fault;
}

}  // namespace softgrip::control
