#include "simulation/emulator/fault.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/enum_table.h"
#include "document/reader.h"
#include "drivers/modbus/modbus_request.h"
#include "simulation/plant/fault_reader.h"

namespace softgrip::simulation {
namespace {

constexpr auto kind_names = enum_names<FaultKind>({{FaultKind::lost_request, "lost_request"},
                                                   {FaultKind::no_reply, "no_reply"},
                                                   {FaultKind::late_reply, "late_reply"},
                                                   {FaultKind::dripped_reply, "dripped_reply"},
                                                   {FaultKind::cut_reply, "cut_reply"},
                                                   {FaultKind::repeated_reply, "repeated_reply"},
                                                   {FaultKind::wrong_unit, "wrong_unit"},
                                                   {FaultKind::wrong_transaction, "wrong_transaction"},
                                                   {FaultKind::wrong_length, "wrong_length"},
                                                   {FaultKind::exception_reply, "exception_reply"},
                                                   {FaultKind::settling, "settling"},
                                                   {FaultKind::few_registers, "few_registers"},
                                                   {FaultKind::stray_bytes, "stray_bytes"},
                                                   {FaultKind::disconnect, "disconnect"},
                                                   {FaultKind::ignored_write, "ignored_write"},
                                                   {FaultKind::sensor_stuck, "sensor_stuck"},
                                                   {FaultKind::sensor_jumping, "sensor_jumping"},
                                                   {FaultKind::sensor_out_of_range, "sensor_out_of_range"},
                                                   {FaultKind::line_blocked, "line_blocked"},
                                                   {FaultKind::line_leaking, "line_leaking"},
                                                   {FaultKind::object_removed, "object_removed"}});

constexpr double longest_s = 86400;

/// Shortest duration and shortest interval that a faults file may contain [s].
constexpr double shortest_s = 1e-4;

document::Range up_to(double upper) {
  return {0, upper};
}

/// Reads the keys of the fault that other kinds of faults do not have.
void read_own_keys(FaultSpec& fault, document::MapReader& map) {
  switch (fault.kind) {
    case FaultKind::late_reply:
      fault.delay_s = map.number("delay_s", up_to(60));
      break;
    case FaultKind::dripped_reply:
      fault.interval_s = map.number("interval_s", up_to(60));
      break;
    case FaultKind::exception_reply:
      fault.code = static_cast<std::uint8_t>(map.integer("code", {1, 255}));
      break;
    case FaultKind::settling:
      fault.settle_s = map.number("settle_s", up_to(60));
      break;
    case FaultKind::few_registers:
      fault.most = static_cast<std::uint16_t>(map.integer("most", {1, drivers::max_read_registers}));
      break;
    case FaultKind::stray_bytes:
      fault.before = static_cast<std::uint16_t>(map.integer("before", {0, drivers::max_pdu}));
      fault.behind = static_cast<std::uint16_t>(map.integer("behind", {0, drivers::max_pdu}));
      break;
    case FaultKind::sensor_jumping:
      fault.interval_s = map.number("interval_s", {shortest_s, 60});
      break;
    default:
      break;
  }
  read_own_keys(map, fault.line);
  read_own_keys(map, fault.sensor, "by_mm");
}

FaultSpec read_fault(const document::Document& document, const document::Node& node,
                     const std::vector<std::string>& channels, document::Problems& problems) {
  document::MapReader map(document, node, problems, "fault");
  std::string name = map.text("name");
  FaultSpec fault = fault_of(map.choice("kind", kind_names));
  fault.name = std::move(name);
  fault.at_s = map.optional_number("at_s", up_to(longest_s));
  fault.for_s = map.optional_number("for_s", document::Range{shortest_s, longest_s});
  if (on_the_wire(fault.kind)) {
    if (const auto replies = map.optional_integer("replies", {1, 1'000'000})) {
      fault.replies = static_cast<std::uint32_t>(*replies);
    }
  }
  if (of_a_channel(fault.kind)) fault.channel = map.optional_choice("channel", channels);
  read_own_keys(fault, map);
  return fault;
}

}  // namespace

std::string_view name_of(FaultKind kind) noexcept {
  return kind_names[kind];
}

FaultSpec fault_of(FaultKind kind) {
  using Line = LineFault::Kind;
  using Sensor = SensorFault::Kind;
  FaultSpec fault;
  fault.kind = kind;
  if (kind == FaultKind::line_blocked) fault.line.kind = Line::blocked;
  if (kind == FaultKind::line_leaking) fault.line.kind = Line::leaking;
  if (kind == FaultKind::sensor_stuck) fault.sensor.kind = Sensor::stuck;
  if (kind == FaultKind::sensor_jumping) fault.sensor.kind = Sensor::offset;
  if (kind == FaultKind::sensor_out_of_range) fault.sensor.kind = Sensor::out_of_range;
  return fault;
}

std::vector<FaultSpec> read_faults(const document::Document& document,
                                   const std::vector<std::string>& channels, document::Problems& problems) {
  document::MapReader map(document, document.root, problems, "faults file");
  std::vector<FaultSpec> faults;
  for (const document::Node* node : map.sequence("faults", true)) {
    FaultSpec fault = read_fault(document, *node, channels, problems);
    const bool taken = std::any_of(faults.begin(), faults.end(),
                                   [&](const FaultSpec& other) { return other.name == fault.name; });
    if (taken) problems.add(document.problem(node->at, "fault '" + fault.name + "' is defined twice"));
    faults.push_back(std::move(fault));
  }
  return faults;
}

}  // namespace softgrip::simulation
