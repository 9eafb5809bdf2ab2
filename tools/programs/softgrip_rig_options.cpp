#include "tools/programs/softgrip_rig_options.h"

#include <algorithm>
#include <filesystem>

#include "base/files.h"
#include "base/net/listener.h"
#include "drivers/modbus/serial_port.h"
#include "model/file/model_file.h"
#include "rig/board_map_file.h"
#include "rig/rig_file.h"
#include "simulation/emulator/finger.h"
#include "simulation/emulator/server.h"
#include "tools/command_line/command.h"
#include "tools/command_line/input_files.h"
#include "tools/command_line/output.h"

namespace softgrip::tools {
namespace {

// Difference between the noise seeds of two channels with consecutive indices. Any odd number is suitable.
constexpr std::uint64_t seed_step = 0x9e3779b97f4a7c15;

/// Returns the path of a board file. `board` is the path itself, or the name of a file in config/boards.
std::string board_path(const std::string& board) {
  const bool is_path = board.find('/') != std::string::npos || board.ends_with(".yaml");
  return is_path ? board : configuration_path("boards") + "/" + board + ".yaml";
}

/// Reports that the board file does not exist, and suggests the existing name that is most similar.
ExitCode no_such_board(const std::string& board, const std::string& path) {
  const std::vector<std::string> names = document_names(std::filesystem::path(path).parent_path());
  const std::string stem = std::filesystem::path(path).stem();
  const std::string near = document::nearest(stem, names);
  std::string message = "there is no board map " + path;
  if (!near.empty()) {
    message +=
        "; did you mean " +
        (board == stem ? near : (std::filesystem::path(path).parent_path() / (near + ".yaml")).string()) +
        "?";
  } else if (!names.empty()) {
    message += "; available:";
    for (const std::string& name : names) message += (&name == names.data() ? " " : ", ") + name;
  }
  return fail(ExitCode::io, message);
}

std::vector<simulation::PlantSettings> make_plants(const Options& options, std::size_t channels,
                                                   document::Problems& problems) {
  std::vector<simulation::PlantSettings> plants(channels);
  for (std::size_t i = 0; i < channels; ++i) {
    plants[i].displacement_noise_mm = options.noise_mm;
    plants[i].pressure_noise_kpa = options.pressure_noise_kpa;
    plants[i].seed = options.seed + i * seed_step;
    if (!options.object.empty()) plants[i].object = simulation::object_named(options.object);
  }
  for (std::size_t i = 0; i < options.models.size(); ++i) {
    const auto model = model::load_rig_model(options.models[i], problems);
    if (!model) continue;
    for (std::size_t channel = i; channel < channels; channel += options.models.size()) {
      plants[channel].model = *model;
    }
  }
  return plants;
}

void set_watchdog(drivers::BoardWatchdog& watchdog, double timeout_s) {
  using Kind = drivers::BoardWatchdog::Kind;
  watchdog.kind = timeout_s > 0 ? Kind::communication_timeout : Kind::none;
  watchdog.timeout_s = timeout_s;
}

void add_faults(const Options& options, simulation::EmulatorSettings& settings,
                document::Problems& problems) {
  if (!options.faults.empty()) {
    std::vector<std::string> names;
    for (const drivers::ChannelWiring& channel : settings.wiring) names.push_back(channel.name);
    const document::Document document = document::parse_file(options.faults, problems);
    if (problems.empty()) settings.faults = simulation::read_faults(document, names, problems);
  }
  if (options.object_out_at_s) {
    simulation::FaultSpec fault;
    fault.name = simulation::Emulator::object_out;
    fault.kind = simulation::FaultKind::object_removed;
    fault.at_s = options.object_out_at_s;
    settings.faults.push_back(std::move(fault));
  }
}

constexpr std::uint16_t usual_port = 1502;

/// Reads boards, unit ids and wiring from a rig file, in the same way as softgripd.
tl::expected<Setup, ExitCode> setup_of_rig(const std::string& path) {
  const auto rig = read_input(path, rig::load_rig);
  if (!rig) return tl::unexpected{rig.error()};
  const auto* modbus = std::get_if<drivers::ModbusSettings>(&rig->board);
  if (modbus == nullptr) {
    return tl::unexpected{fail(ExitCode::input_refused,
                               path + ": this rig file has no Modbus board that softgrip-rig can emulate")};
  }
  Setup setup;
  for (const drivers::ModbusModuleSettings& module : modbus->modules) {
    setup.emulator.modules.push_back({module.map, module.unit, module.link});
  }
  setup.emulator.wiring = modbus->wiring;
  for (const drivers::ModbusAddress& link : modbus->links) {
    if (const auto* tcp = std::get_if<drivers::TcpAddress>(&link)) {
      setup.addresses.push_back(*tcp);
    } else {
      setup.line = std::get<drivers::SerialLine>(link);
    }
  }
  return setup;
}

tl::expected<Setup, ExitCode> setup_of_boards(const Options& options) {
  Setup setup;
  std::vector<drivers::BoardMap> maps;
  for (const std::string& board : options.boards) {
    const std::string path = board_path(board);
    if (!is_there(path)) return tl::unexpected{no_such_board(board, path)};
    auto map = read_input(path, rig::load_board_map);
    if (!map) return tl::unexpected{map.error()};
    setup.emulator.modules.push_back({*map, static_cast<std::uint8_t>(1 + maps.size()), 0});
    maps.push_back(std::move(*map));
  }
  auto wiring = simulation::default_wiring(maps, options.channels);
  if (!wiring) return tl::unexpected{fail(ExitCode::input_refused, wiring.error())};
  setup.emulator.wiring = std::move(*wiring);
  setup.addresses.push_back({.host = options.bind, .port = usual_port});
  return setup;
}

/// Sets the addresses or the serial line of the modules. Options take precedence over the rig file.
std::optional<ExitCode> place(const Options& options, Setup& setup) {
  if (!options.rtu.empty() || (setup.line && !options.port)) {
    drivers::SerialLine& line = setup.line ? *setup.line : setup.line.emplace();
    if (!options.rtu.empty()) line.device = options.rtu;
    line.baud = options.baud.value_or(line.baud);
    if (options.format && !drivers::set_format(*options.format, line)) {
      return fail(ExitCode::usage, "--format takes 8N1, 8E1, 8O1, 8N2 or 8E2, not '" + *options.format + "'");
    }
    line.turnaround_s = options.turnaround_s.value_or(line.turnaround_s);
    // All modules share one serial line, even if the rig file names several hosts.
    for (simulation::EmulatedModule& module : setup.emulator.modules) module.link = 0;
    setup.emulator.wire = modbus::Wire::rtu;
    return std::nullopt;
  }
  setup.line.reset();
  const bool rtu = std::any_of(setup.addresses.begin(), setup.addresses.end(),
                               [](const drivers::TcpAddress& address) { return address.rtu_framing; });
  if (rtu || options.rtu_over_tcp) setup.emulator.wire = modbus::Wire::rtu;
  if (setup.addresses.empty()) setup.addresses.push_back({.host = options.bind, .port = usual_port});
  for (std::size_t i = 0; i < setup.addresses.size(); ++i) {
    drivers::TcpAddress& address = setup.addresses[i];
    // If the rig file names several hosts, a host with a loopback address keeps this address. Every other
    // host is replaced by the bind address.
    if (setup.addresses.size() == 1 || !net::is_loopback(address.host)) address.host = options.bind;
    if (options.port) address.port = static_cast<std::uint16_t>(*options.port == 0 ? 0 : *options.port + i);
  }
  return std::nullopt;
}

/// Returns an exit code if an input file is a folder or cannot be opened, otherwise nullopt.
std::optional<ExitCode> any_unreadable(const Options& options) {
  std::vector<std::string> files = options.models;
  if (!options.faults.empty()) files.push_back(options.faults);
  for (const std::string& file : files) {
    if (const auto code = refuse_folder(file)) return code;
    if (const auto code = unreadable(file)) return code;
  }
  return std::nullopt;
}

}  // namespace

tl::expected<Setup, ExitCode> make_setup(const Options& options) {
  if (!options.object.empty() && !simulation::object_named(options.object)) {
    return tl::unexpected{
        fail(ExitCode::usage,
             "--object takes stone, screw or POSITION_MM[:YIELDING], not '" + options.object + "'")};
  }
  if (const auto code = any_unreadable(options)) return tl::unexpected{*code};
  std::vector<std::string> inputs = options.models;
  inputs.insert(inputs.end(), {options.faults, options.rig});
  for (const std::string& board : options.boards) inputs.push_back(board_path(board));
  if (const auto code = refuse_overwriting({options.truth}, inputs)) return tl::unexpected{*code};
  auto setup = options.rig.empty() ? setup_of_boards(options) : setup_of_rig(options.rig);
  if (!setup) return setup;
  if (const auto code = place(options, *setup)) return tl::unexpected{*code};
  simulation::EmulatorSettings& emulator = setup->emulator;
  const std::size_t channels = emulator.wiring.size();
  if (options.models.size() > 1 && options.models.size() != channels) {
    return tl::unexpected{fail(ExitCode::usage, "--model was given " + std::to_string(options.models.size()) +
                                                    " times, but the rig has " + std::to_string(channels) +
                                                    (channels == 1 ? " channel" : " channels") +
                                                    ": give 1 model, or 1 model per channel")};
  }
  for (std::size_t i = 0; i < emulator.modules.size(); ++i) {
    simulation::EmulatedModule& module = emulator.modules[i];
    if (options.unit) module.unit = static_cast<std::uint8_t>(*options.unit + i);
    if (options.watchdog_s && module.map.has_outputs())
      set_watchdog(module.map.watchdog, *options.watchdog_s);
  }
  document::Problems problems;
  emulator.plants = make_plants(options, emulator.wiring.size(), problems);
  add_faults(options, emulator, problems);
  if (!problems.empty()) return tl::unexpected{refuse(problems)};
  return setup;
}

}  // namespace softgrip::tools
