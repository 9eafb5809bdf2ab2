#include "simulation/emulator/fault.h"

#include <algorithm>
#include <utility>

#include "base/enum_table.h"
#include "drivers/modbus/modbus_message.h"

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

/// Shortest duration and shortest interval that a faults file may contain [s].
constexpr double shortest_s = 1e-4;

using document::Keys;
using document::optional;
using document::required;
using document::within;

/// The keys of a fault; `own` are the keys of single kinds of faults.
struct FaultKeys {
  Keys<FaultSpec> fault, on_the_wire, of_a_channel;
  std::vector<std::pair<FaultKind, Keys<FaultSpec>>> own;
};

const FaultKeys& fault_keys() {
  using Kind = FaultKind;
  using F = FaultSpec;
  constexpr document::Range stray{0, drivers::max_pdu};
  static const FaultKeys keys{
      {required("name", &F::name, {}, "unique name of the fault"),
       required("kind", &F::kind, kind_names, "kind of the fault, see below"),
       optional("at_s", &F::at_s, {0, 86400},
                "time from the first write to an output of the board until the fault starts", "no start"),
       optional("for_s", &F::for_s, {shortest_s, 86400}, "duration", "until the fault is cleared")},
      {optional("replies", &F::replies, {1, 1'000'000},
                "only for communication faults: the fault ends after this number of affected requests")},
      {{"channel", "name of a channel", "all channels", "only for faults of a channel: affected channel"}},
      {{Kind::late_reply, {required("delay_s", &F::delay_s, {0, 60}, "delay of each reply")}},
       {Kind::dripped_reply, {required("interval_s", &F::interval_s, {0, 60}, "time between two bytes")}},
       {Kind::exception_reply, {required("code", &F::code, {1, 255}, "code of the Modbus exception")}},
       {Kind::settling, {required("settle_s", &F::settle_s, {0, 60}, "time in which requests are lost")}},
       {Kind::few_registers,
        {required("most", &F::most, {1, drivers::max_read_registers},
                  "largest number of registers in one request")}},
       {Kind::stray_bytes,
        {required("before", &F::before, stray, "number of bytes before each reply"),
         required("behind", &F::behind, stray, "number of bytes after each reply")}},
       {Kind::sensor_jumping,
        {required("interval_s", &F::interval_s, {shortest_s, 60}, "duration of an interval"),
         within(&F::sensor, offset_key("by_mm"))}},
       {Kind::line_leaking, {within(&F::line, leak_key())}}}};
  return keys;
}

FaultSpec read_fault(document::MapReader map, const std::vector<std::string>& channels) {
  FaultSpec fault;
  read_keys(map, fault_keys().fault, fault);
  fault.line = fault_of(fault.kind).line;
  fault.sensor = fault_of(fault.kind).sensor;
  if (on_the_wire(fault.kind)) read_keys(map, fault_keys().on_the_wire, fault);
  if (of_a_channel(fault.kind)) fault.channel = map.optional_choice("channel", channels);
  for (const auto& [kind, keys] : fault_keys().own)
    if (kind == fault.kind) read_keys(map, keys, fault);
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

std::vector<document::KeyFacts> faults_file_keys() {
  const FaultKeys& all = fault_keys();
  std::vector<document::KeyFacts> facts = facts_of(all.fault, all.on_the_wire, all.of_a_channel);
  for (const auto& [kind, keys] : all.own) {
    for (document::KeyFacts& key : facts_of(keys)) {
      key.meaning = "only for `" + std::string(name_of(kind)) + "`: " + key.meaning;
      facts.push_back(std::move(key));
    }
  }
  return facts;
}

std::vector<FaultSpec> read_faults(const document::Document& document,
                                   const std::vector<std::string>& channels, document::Problems& problems) {
  document::MapReader map(document, document.root, problems, "faults file");
  std::vector<FaultSpec> faults;
  for (const document::Node* node : map.sequence("faults", true)) {
    FaultSpec fault = read_fault(map.inner(*node, "fault"), channels);
    const bool taken = std::any_of(faults.begin(), faults.end(),
                                   [&](const FaultSpec& other) { return other.name == fault.name; });
    if (taken) map.report(node->at, "fault '" + fault.name + "' is defined twice");
    faults.push_back(std::move(fault));
  }
  return faults;
}

}  // namespace softgrip::simulation
