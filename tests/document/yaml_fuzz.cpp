// Fuzz target: parses arbitrary bytes, calls every getter and formats every message. Start it with the
// arguments -dict=yaml.dict corpus/.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "document/node.h"
#include "document/reader.h"

namespace {

using softgrip::document::Document;
using softgrip::document::MapReader;
using softgrip::document::Node;
using softgrip::document::Problems;

/// Aborts in three cases: the tree exceeds its limits, two of the first 50 keys of a map are equal, or a line
/// or column number is below 1.
void check(const Node& node, int depth, std::size_t& nodes) {
  if (++nodes > softgrip::document::Bounds{}.nodes || depth > softgrip::document::Bounds{}.depth)
    std::abort();
  if (node.at.line < 1 || node.at.column < 1) std::abort();
  for (const Node& item : node.items) check(item, depth + 1, nodes);
  for (std::size_t i = 0; i < node.entries.size(); ++i) {
    for (std::size_t j = 0; j < i && i < 50; ++j) {
      if (node.entries[i].key == node.entries[j].key) std::abort();
    }
    check(node.entries[i].value, depth + 1, nodes);
  }
}

/// Calls every getter with a key for each map, so that every type of hint can occur.
void read(const Document& document, const Node& node, Problems& problems) {
  {
    MapReader reader(document, node, problems, "the map");
    reader.number("delay_s", {0, 10});
    reader.optional_number("pressure_max_kpa", {0, 100});
    reader.integer("output", {0, 7});
    reader.optional_integer("priority", {1, 80});
    reader.boolean("required");
    reader.text("name");
    reader.optional_text("source");
    reader.choice("feedforward", {"none", "bouc_wen", "full_model"});
    reader.numbers("at_v", 2, {0, 10});
    reader.sequence("channels", true);
    reader.child("limits", false);
    reader.warn("name", "a warning");
  }
  for (const Node& item : node.items) read(document, item, problems);
  for (const Node::Entry& entry : node.entries) read(document, entry.value, problems);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Problems problems;
  const Document document = softgrip::document::parse(
      "fuzz.yaml", std::string(reinterpret_cast<const char*>(data), size), problems);
  std::size_t nodes = 0;
  check(document.root, 0, nodes);
  if (!document.complete && problems.empty()) std::abort();
  read(document, document.root, problems);
  static_cast<void>(problems.without_repeats().format());
  return 0;
}
