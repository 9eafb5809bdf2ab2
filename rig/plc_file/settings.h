#pragma once
// What softgrip-plc must know: config/plc.yaml as plain values. docs/reference/plc-map.md is the manual.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "document/node.h"
#include "document/problem.h"
#include "rig/plc_file/register_map.h"

namespace softgrip::plc {

/// What a number of the recipe register starts.
struct Recipe {
  std::uint16_t number = 0;  ///< from 1
  std::string sequence;
  std::string squeeze;  ///< the parameter of the sequence that the register sets; empty: none
  std::string speed;
  std::string displacement;
};

/// What is done when the master falls silent.
enum class Reaction : std::uint8_t { nothing, stop, vent, release };

struct Settings {
  std::string name;
  std::string socket;   ///< of softgripd
  std::string address;  ///< numeric
  std::uint16_t port = 502;
  std::vector<std::string> allow;  ///< numeric addresses of masters
  std::size_t max_masters = 4;
  double idle_s = 60;  ///< a master that asks nothing for so long is disconnected
  double silence_s = 2;
  Reaction when_silent = Reaction::stop;
  std::vector<Recipe> recipes;
  RegisterMap registers;
};

/// Reads a document, adding its problems.
[[nodiscard]] Settings read_settings(const document::Document& document, document::Problems& problems);
/// Reads the file; nothing if there are problems, which are all added.
[[nodiscard]] std::optional<Settings> load_settings(const std::string& path, document::Problems& problems);

}  // namespace softgrip::plc
