#pragma once
// The settings of softgrip-plc: config/plc.yaml as plain values. docs/reference/plc-map.md describes the
// file.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "document/node.h"
#include "document/problem.h"
#include "rig/plc_file/register_map.h"

namespace softgrip::plc {

/// A sequence and its parameters, which the PLC selects by a number in the recipe register.
struct Recipe {
  std::uint16_t number = 0;  ///< number of the recipe in the recipe register, from 1
  std::string sequence;
  std::string squeeze;       ///< parameter of the sequence that the register `squeeze` sets; empty: the
                             ///< register has no effect
  std::string speed;         ///< parameter of the sequence that the register `speed` sets; empty: the
                             ///< register has no effect
  std::string displacement;  ///< parameter of the sequence that the register `displacement` sets; empty: the
                             ///< register has no effect
};

/// Action of the gateway if the PLC stops responding.
enum class Reaction : std::uint8_t { nothing, stop, vent, release };

struct Settings {
  std::string name;
  std::string socket;   ///< path of softgripd's socket
  std::string address;  ///< numeric IP address on which the gateway listens
  std::uint16_t port = 502;
  std::vector<std::string> allow;  ///< numeric addresses of the Modbus clients (PLCs) that may connect
  std::size_t max_masters = 4;     ///< largest number of clients that are connected at the same time
  double idle_s = 60;              ///< a client that has sent no request for this time is disconnected [s]
  /// If the PLC's heartbeat has not changed for this time, the gateway takes the action `when_silent` [s].
  double silence_s = 2;
  Reaction when_silent = Reaction::stop;
  std::vector<Recipe> recipes;
  RegisterMap registers;
};

/// Reads the settings from a document, and adds problems of the document to `problems`.
[[nodiscard]] Settings read_settings(const document::Document& document, document::Problems& problems);
/// Reads the settings from a file. Adds all problems of the file to `problems`, and returns nothing if there
/// are any.
[[nodiscard]] std::optional<Settings> load_settings(const std::string& path, document::Problems& problems);

}  // namespace softgrip::plc
