#pragma once
// The settings of softgrip-plc: config/plc.yaml as plain values. docs/reference/plc-map.md describes the
// file.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/enum_table.h"
#include "document/node.h"
#include "document/problem.h"
#include "rig/plc_file/register_map.h"

namespace softgrip::document {
struct KeyFacts;
}

namespace softgrip::plc {

/// A sequence and its parameters. The PLC selects a sequence by the number in the recipe register. A register
/// whose parameter is empty has no effect.
struct Recipe {
  std::uint16_t number = 0;
  std::string sequence;
  std::string squeeze;
  std::string speed;
  std::string displacement;
};

/// Action of the gateway if the heartbeat of the PLC stops.
enum class Reaction : std::uint8_t { nothing, stop, vent, release };
inline constexpr auto reaction_names = enum_names<Reaction>({{Reaction::nothing, "nothing"},
                                                             {Reaction::stop, "stop"},
                                                             {Reaction::vent, "vent"},
                                                             {Reaction::release, "release"}});

/// The contents of the gateway file. file_keys() describes the members.
struct Settings {
  std::string name;
  std::string socket;
  std::string address;
  std::uint16_t port = 502;
  std::vector<std::string> allow;  ///< normal forms of the addresses, each once; see net::normal_address()
  std::size_t max_masters = 4;
  double idle_s = 60;
  double silence_s = 2;
  Reaction when_silent = Reaction::stop;
  std::vector<Recipe> recipes;
  RegisterMap registers;
};

/// Returns all keys of the gateway file. The name of a key begins with the map that contains it: "listen:
/// port".
[[nodiscard]] std::vector<document::KeyFacts> file_keys();
/// Reads the settings from a document, and adds problems of the document to `problems`.
[[nodiscard]] Settings read_settings(const document::Document& document, document::Problems& problems);
/// Reads the settings from a file. Adds all problems of the file to `problems`, and returns nothing if there
/// are any.
[[nodiscard]] std::optional<Settings> load_settings(const std::string& path, document::Problems& problems);

}  // namespace softgrip::plc
