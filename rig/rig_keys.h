#pragma once
// Declares all keys of a rig file: names, permitted values, defaults and meanings. rig_file*.cpp reads the
// file with these declarations, and docs/reference/rig-file.md contains their tables.

#include "document/schema.h"
#include "rig/rig_file.h"

namespace softgrip::rig {

using document::Keys;

/// Largest raw number of a converter of this computer.
inline constexpr double largest_raw = (1 << 24) - 1;

/// Permitted values in a rig file for a pressure at a valve or in its line [kPa].
inline constexpr document::Range line_pressure_kpa{-200, 10'000};

/// The keys of each map of a rig file; rig_tables() shows the map to which each key belongs. A key without a
/// member of the settings is read by the function that reads its map. This function also checks the
/// conditions that combine several keys.
struct RigKeys {
  Keys<control::RigSettings> rig, rest;
  Keys<LoopSettings> loop, exchange, commands;
  Keys<ReconnectSettings> connecting;
  Keys<RigFile> budget, seed;
  Keys<drivers::ModbusModuleSettings> module;
  Keys<drivers::TcpAddress> tcp, framing, rtu_framing, numbering;
  Keys<drivers::LinkHabits> habits;
  Keys<drivers::SerialLine> serial;
  Keys<drivers::IioSettings> iio;
  Keys<drivers::IioTerminal> iio_terminal, iio_output;
  Keys<drivers::IioHeartbeat> heartbeat;
  Keys<simulation::SimulatedBoardSettings> simulated;
  Keys<simulation::SimulatedChannel> converters;
  Keys<simulation::PlantSettings> plant;
  Keys<control::ChannelSettings> channel, channel_parts;
  Keys<control::FeedforwardSettings> feedforward;
  Keys<control::LimitSettings> rest_pressure, limits;
  Keys<control::PidSettings> pid;
  Keys<ValveFacts> output, valve;
  Keys<drivers::InputWiring> input;
  Keys<control::SafetySettings> safety;
  Keys<control::FaultSettings> faults;
  Keys<control::PlausibilitySettings> plausibility;
  Keys<control::DetectionSettings> detection;
  Keys<control::ModelHealthSettings> model_health;
  Keys<RealTimeSettings> real_time;
  Keys<RecorderSettings> recorder;
  Keys<SocketSettings> socket;
  Keys<SocketFile> look;
  Keys<GpioSettings> gpio, gpio_enable;
  Keys<drivers::GpioLineSettings> gpio_line, gpio_input;
};
[[nodiscard]] const RigKeys& rig_keys();
/// Declares the keys of the boards and of the lines of the computer. Only rig_keys() calls this function.
void declare_board_keys(RigKeys& keys);

/// Returns the keys of each table of docs/reference/rig-file.md, with the name of the table.
[[nodiscard]] document::KeyTables rig_tables();

}  // namespace softgrip::rig
