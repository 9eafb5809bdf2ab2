#pragma once
// Settings of softgrip-plc: config/plc.yaml as plain values. docs/reference/plc-map.md describes the file.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "document/node.h"
#include "document/problem.h"
#include "rig/plc_file/register_map.h"

namespace softgrip::plc {

/// The sequence and its parameters that a number in the recipe register selects.
struct Recipe {
  std::uint16_t number = 0;  ///< number in the recipe register, from 1
  std::string sequence;
  std::string squeeze;       ///< parameter of the sequence that the register `squeeze` sets; empty: none
  std::string speed;         ///< parameter that the register `speed` sets; empty: none
  std::string displacement;  ///< parameter that the register `displacement` sets; empty: none
};

/// Action of the gateway when the PLC stops responding.
enum class Reaction : std::uint8_t { nothing, stop, vent, release };

struct Settings {
  std::string name;
  std::string socket;   ///< socket of softgripd
  std::string address;  ///< numeric IP address at which the gateway listens
  std::uint16_t port = 502;
  std::vector<std::string> allow;  ///< numeric addresses of the permitted Modbus clients (PLCs)
  std::size_t max_masters = 4;     ///< largest number of connected clients
  double idle_s = 60;              ///< a client that sends no request for this time is disconnected [s]
  /// Time without a change of the PLC's heartbeat after which `when_silent` applies [s].
  double silence_s = 2;
  Reaction when_silent = Reaction::stop;
  std::vector<Recipe> recipes;
  RegisterMap registers;
};

/// Reads a document and adds its problems to `problems`.
[[nodiscard]] Settings read_settings(const document::Document& document, document::Problems& problems);
/// Reads the file and adds all its problems to `problems`. Returns nothing if there is a problem.
[[nodiscard]] std::optional<Settings> load_settings(const std::string& path, document::Problems& problems);

}  // namespace softgrip::plc
