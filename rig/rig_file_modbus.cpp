// Reads a Modbus board from a rig file. The modules of the board are at network hosts or on a serial line.

#include <arpa/inet.h>

#include <algorithm>
#include <array>

#include "base/numbers.h"
#include "base/text.h"
#include "document/node.h"
#include "drivers/modbus/serial_port.h"
#include "rig/board_map_file.h"
#include "rig/rig_file_reader.h"

namespace softgrip::rig {

namespace {

using document::Node;
using drivers::ModbusModuleSettings;
using drivers::ModbusSettings;

constexpr int largest_tcp_unit = 255;
// Largest permitted unit id. The unit ids 248 to 255 are reserved, and 0 is the broadcast address, to which
// no module responds (Modbus over Serial Line V1.02, 2.2).
constexpr int largest_rtu_unit = 247;
/// Usual delay of the responses by an adapter [s]. If an adapter has a longer delay, a warning is given.
constexpr double usual_latency_s = 0.0015;

/// Checks that a host is a numeric address. Host names are not accepted, because resolving a name may take an
/// unlimited time.
void check_host(MapReader& reader, const std::string& host) {
  std::array<unsigned char, sizeof(in6_addr)> address{};
  if (host.empty() || ::inet_pton(AF_INET, host.c_str(), address.data()) == 1 ||
      ::inet_pton(AF_INET6, host.c_str(), address.data()) == 1) {
    return;
  }
  reader.report("host", "`host` must be a numeric address, found `" + document::shown(host) + "`",
                host == "localhost" ? "write 127.0.0.1" : "host names are not resolved");
}

std::optional<drivers::BoardMap> read_module_map(Context& context, MapReader& reader) {
  const std::size_t before = context.problems.size();
  const auto document = named_document(context, reader, "map", InputFile::Role::board);
  if (!document) return std::nullopt;
  auto map = read_board_map(*document, context.problems);
  if (context.problems.size() != before) map.reset();
  return map;
}

/// Reads the settings of a session that are not part of the Modbus specification. check_waits() later
/// compares their waiting times with the deadlines.
drivers::LinkHabits read_habits(Context& context, MapReader& reader) {
  drivers::LinkHabits habits;
  read_keys(reader, rig_keys().habits, habits);
  const auto note = [&](std::string_view key, double value_s, std::string_view deadline) {
    if (reader.good(key)) context.waits.push_back({reader.where(key), key, value_s, deadline});
  };
  note("settle_s", habits.settle_s, "connect_deadline_s");
  note("repeat_after_s", habits.repeat_after_s, "exchange_deadline_s");
  return habits;
}

/// Checks that each waiting time is shorter than the deadline that includes it.
void check_waits(Context& context) {
  const RigFile& rig = context.rig;
  for (const Context::Wait& wait : context.waits) {
    const bool connecting = wait.deadline == "connect_deadline_s";
    const double longest_s =
        connecting ? seconds(rig.reconnect.connect_deadline.count()) : rig.loop.exchange_deadline_s;
    if (wait.value_s < longest_s) continue;
    context.problems.add(context.document.problem(
        wait.at,
        "`" + std::string(wait.key) + "` is not below `" + std::string(wait.deadline) + "` (" +
            written(longest_s) +
            " s): " + (connecting ? "so no session could be opened" : "so requests would never be repeated"),
        connecting
            ? "raise `connect_deadline_s`, which must cover the connection, `settle_s` and the first requests"
            : "`exchange_deadline_s` is the deadline for all requests of an exchange together"));
  }
}

/// Reads `accept_no_transaction_id`. If responses have no transaction id, the file must contain this key with
/// the sentence that describes the risk.
void read_numbering(MapReader& reader, drivers::TcpAddress& address) {
  constexpr std::string_view key = "accept_no_transaction_id";
  constexpr std::string_view words = "a late answer may pass for the answer to a later request";
  const auto said = reader.optional_text(key);
  if (!said) return;
  address.numbered = false;
  if (*said == words) return;
  reader.report(key, "the text does not state the accepted risk word by word",
                "write " + std::string(key) + ": \"" + std::string(words) + "\"");
}

void read_framing(MapReader& reader, drivers::TcpAddress& address) {
  read_keys(reader, rig_keys().framing, address);
  if (!address.rtu_framing) return read_numbering(reader, address);
  read_keys(reader, rig_keys().rtu_framing, address);
}

/// Reads the modules of a board. If there is a single module, the map of the board contains `map` and `unit`,
/// and on a network also `host` and `port`. Several modules are in a list under `modules`, and each module
/// has a name.
class ModulesReader {
 public:
  ModulesReader(Context& context, ModbusSettings& settings, bool serial)
      : context_(context), settings_(settings), serial_(serial) {}

  void read(MapReader& board) {
    if (!board.has("modules")) {
      add(board, "");
      return;
    }
    for (const Node* item : board.sequence("modules", true)) {
      MapReader reader(context_.document, *item, context_.problems, "a module");
      const std::string name = read_name(reader, "name");
      const auto same = [&](const KnownModule& known) { return known.name == name; };
      if (!name.empty() && std::any_of(context_.modules.begin(), context_.modules.end(), same)) {
        reader.report("name", "another module is called `" + name + "`");
      }
      add(reader, name);
    }
    if (board.good("modules") && settings_.modules.empty()) {
      board.report("modules", "`modules` must list at least one module");
    }
  }

 private:
  void add(MapReader& reader, const std::string& name) {
    ModbusModuleSettings module;
    const auto map = read_module_map(context_, reader);
    if (map) module.map = *map;
    module.name = name.empty() ? module.map.name : name;
    bool rtu = serial_;
    if (!serial_) {
      const drivers::TcpAddress address = read_address(reader);
      rtu = address.rtu_framing;
      module.link = link_of(reader, address);
    }
    module.unit = static_cast<std::uint8_t>(reader.integer(
        "unit", rtu ? document::Range{1, largest_rtu_unit} : document::Range{0, largest_tcp_unit}));
    const auto same = [&](const ModbusModuleSettings& other) {
      return other.link == module.link && other.unit == module.unit;
    };
    if (reader.good("unit") && std::any_of(settings_.modules.begin(), settings_.modules.end(), same)) {
      reader.report("unit",
                    "another module has the same unit id at the same address or on the same serial line");
    }
    KnownModule known{module.name, std::nullopt};
    if (map) known.terminals = drivers::terminals_of(*map);
    if (known.terminals) known.terminals->name = module.name;
    context_.modules.push_back(std::move(known));
    settings_.modules.push_back(std::move(module));
  }

  drivers::TcpAddress read_address(MapReader& reader) {
    drivers::TcpAddress address;
    read_keys(reader, rig_keys().tcp, address);
    check_host(reader, address.host);
    address.habits = read_habits(context_, reader);
    read_framing(reader, address);
    return address;
  }

  /// Returns the index of the link to an address. If there is no such link yet, adds it. Modules at the same
  /// host and port share a session, so the rig file must contain equal session settings for these modules.
  std::size_t link_of(MapReader& reader, const drivers::TcpAddress& address) {
    auto& links = settings_.links;
    for (std::size_t link = 0; link < links.size(); ++link) {
      const auto& other = std::get<drivers::TcpAddress>(links[link]);
      if (other.host != address.host || other.port != address.port) continue;
      if (other != address) {
        reader.report(
            "port",
            "another module at this host and port has different settings, but both modules share one session",
            "give both modules the same `settle_s`, `repeat_after_s`, `framing` and other framing keys");
      }
      return link;
    }
    links.emplace_back(address);
    return links.size() - 1;
  }

  Context& context_;
  ModbusSettings& settings_;
  bool serial_;
};

constexpr std::array<std::uint32_t, 12> baud_rates{1200,  2400,   4800,   9600,   19200,  38400,
                                                   57600, 115200, 230400, 460800, 921600, 1000000};

void read_format(MapReader& reader, drivers::SerialLine& line) {
  const auto known = drivers::formats();
  const std::vector<std::string> texts(known.begin(), known.end());
  (void)drivers::set_format(texts[reader.choice("format", texts)], line);
}

/// Warns of a device name that changes with the order in which the adapters are connected.
void advise_on_name(MapReader& reader, const std::string& device) {
  if (device.rfind("/dev/ttyUSB", 0) != 0 && device.rfind("/dev/ttyACM", 0) != 0) return;
  reader.warn(
      "device",
      document::in_backticks(device) + " may name a different adapter after the next start of the computer",
      "use the permanent name of the adapter, which this command lists: ls -l /dev/serial/by-id");
}

/// Reports a device name that several adapters have. For such a name, the system would use the adapter that
/// was connected last. Accepts a name that does not exist, because the rig may be connected to another
/// computer.
void check_device(MapReader& reader, const std::string& device) {
  if (!reader.good("device")) return;
  const auto unclear = drivers::unclear_serial_device(device);
  if (unclear && unclear->several) reader.report("device", unclear->message, unclear->hint);
}

/// If the file does not contain the latency of the adapter, gets the latency of the connected adapter from
/// the kernel. Warns of an adapter with a long latency.
void find_adapter_latency(MapReader& reader, drivers::SerialLine& line) {
  const auto found = drivers::adapter_latency(line.device);
  if (found && !reader.has("adapter_latency_s")) line.adapter_latency_s = found->seconds;
  if (!found || found->seconds <= usual_latency_s) return;
  reader.warn("device",
              "the adapter delays every response by up to " + written(found->seconds * 1e3) +
                  " ms (its latency timer)",
              "echo 1 > " + found->path + " (permanently: in a udev rule, ATTR{device/latency_timer}=\"1\")");
}

drivers::SerialLine read_line(Context& context, MapReader& reader) {
  drivers::SerialLine line;
  read_keys(reader, rig_keys().serial, line);
  if (reader.good("device") && line.device.front() != '/') {
    reader.report("device",
                  "`device` must be an absolute path, found `" + document::shown(line.device) + "`");
  }
  // If the rig is read from stored texts, this computer may not have the devices of the rig.
  if (context.stored == nullptr) check_device(reader, line.device);
  if (reader.good("baud") && std::find(baud_rates.begin(), baud_rates.end(), line.baud) == baud_rates.end()) {
    reader.report("baud", "`baud` must be one of the usual rates",
                  with_commas(baud_rates, [](std::uint32_t rate) { return std::to_string(rate); }));
  }
  read_format(reader, line);
  find_adapter_latency(reader, line);
  line.habits = read_habits(context, reader);
  const double usual_s = line.turnaround_s + line.adapter_latency_s;
  if (reader.good("repeat_after_s") && line.habits.repeat_after_s <= usual_s) {
    reader.report("repeat_after_s", "`repeat_after_s` is not above the " + written(usual_s) +
                                        " s that a response of a module through the adapter takes, so "
                                        "repeated requests would collide with responses on the line");
  }
  advise_on_name(reader, line.device);
  return line;
}

void read_board(Context& context, MapReader& reader, ModbusSettings settings, bool rtu) {
  ModulesReader(context, settings, rtu).read(reader);
  read_timing(context, reader);
  check_waits(context);
  context.rig.board = std::move(settings);
}

}  // namespace

void read_modbus_tcp(Context& context, const Node& node) {
  MapReader reader(context.document, node, context.problems, "modbus_tcp");
  read_board(context, reader, {}, false);
}

void read_modbus_rtu(Context& context, const Node& node) {
  MapReader reader(context.document, node, context.problems, "modbus_rtu");
  ModbusSettings settings;
  settings.links.emplace_back(read_line(context, reader));
  read_board(context, reader, std::move(settings), true);
}

}  // namespace softgrip::rig
