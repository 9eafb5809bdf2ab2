#include "model/file/model_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "base/numbers.h"
#include "document/reader.h"
#include "model/catalogue.h"
#include "model/file/earlier_blocks.h"

namespace softgrip::model {
namespace {

using document::Document;
using document::MapReader;
using document::Node;
using document::Problems;

constexpr std::array stations{Station::valve, Station::actuator, Station::load, Station::sensor};

std::vector<std::string> ids_of(Station station) {
  std::vector<std::string> ids;
  for (const BlockDescriptor& descriptor : catalogue()) {
    if (descriptor.info.station == station) ids.emplace_back(descriptor.info.id);
  }
  return ids;
}

// Reads the value of one parameter and checks that the declaration of the parameter permits this value.
double read_value(MapReader& map, const ParameterSpec& spec, const std::string& name) {
  if (!std::isnan(spec.if_left_out) && !map.has(name)) return spec.if_left_out;
  if (spec.whole) {
    return static_cast<double>(map.integer(name, {spec.lower, spec.upper}));
  }
  return map.number(name, {spec.lower, spec.upper});
}

// Returns the number of repeated parts in a block: the largest number in its keys (k1, c1, k2, c2, ...), but
// at least min_parts.
std::size_t count_parts(const MapReader& map, const BlockDescriptor& descriptor) {
  const std::vector<std::string> keys = map.keys();
  const auto given = [&](std::size_t index) {
    return std::any_of(keys.begin(), keys.end(),
                       [&](const std::string& key) { return descriptor.is_named(index, key); });
  };
  const std::size_t first = descriptor.parameters.size(), size = descriptor.repeated.size();
  std::size_t parts = 0;
  for (std::size_t i = 0; i < descriptor.max_parts * size; ++i) {
    if (given(first + i)) parts = i / size + 1;
  }
  return std::max(parts, descriptor.min_parts);
}

bool does_something(const BlockSpec& block) {
  for (std::size_t i = 0; i < block.values.size(); ++i) {
    const double neutral = catalogue()[block.type].spec(i).neutral;
    if (!std::isnan(neutral) && block.values[i] != neutral) return true;
  }
  return false;
}

/// Returns true if the map has a key of the earlier block that the present block with the same id does not
/// have.
bool has_key_of_another(const Node& map, const EarlierBlock& earlier, std::size_t today) {
  const auto has = [](std::size_t type, const std::string& key) {
    const BlockDescriptor& descriptor = catalogue()[type];
    const BlockSpec largest = default_block(type, descriptor.max_parts);
    return find_parameter(largest, key).has_value();
  };
  return std::any_of(map.entries.begin(), map.entries.end(), [&](const Node::Entry& entry) {
    if (has(today, entry.key)) return false;
    return entry.key == earlier.choice || std::any_of(earlier.types.begin(), earlier.types.end(),
                                                      [&](std::size_t type) { return has(type, entry.key); });
  });
}

constexpr std::string_view output_unit_key = "output_unit";

OutputUnit read_output_unit(MapReader& map) {
  std::vector<std::string> names;
  for (const OutputUnit unit : all_output_units) names.emplace_back(name_of(unit));
  return all_output_units[map.optional_choice(output_unit_key, names).value_or(0)];
}

class ModelReader {
 public:
  ModelReader(const Document& document, Problems& problems) : document_(document), problems_(problems) {}

  Model read() {
    Model model;
    MapReader top(document_, document_.root, problems_, "model");
    model.name = top.text("name");
    model.source = top.text("source");
    model.output_unit = read_output_unit(top);
    bool is_actuator_read = false;
    for (const Station station : stations) {
      const bool required = station == Station::actuator;
      const std::size_t before = problems_.size();
      for (const Node* item : top.sequence(name_of(station), required)) read_block(*item, station, model);
      if (required) is_actuator_read = problems_.size() == before;
    }
    const Node* const actuator = top.child(name_of(Station::actuator), false);
    top.finish();
    // If the actuator itself has a problem, a message about a missing element would only repeat this problem.
    if (!has_element_ && document_.complete && is_actuator_read && actuator != nullptr &&
        !actuator->refused) {
      top_problem("the actuator has no element that turns pressure into displacement",
                  "for example bouc_wen or kelvin_voigt is such an element");
    }
    return model;
  }

 private:
  void top_problem(std::string message, std::string hint) {
    problems_.add(document_.problem(document_.root.at, std::move(message), std::move(hint)));
  }

  void read_block(const Node& item, Station station, Model& model) {
    if (item.kind != Node::Kind::map || item.entries.size() != 1) {
      problems_.add(document_.problem(item.at, "a block must be a map with one key, the id of the block",
                                      "for example `- valve_lag: {time_constant_s: 0.05}`"));
      return;
    }
    const Node::Entry& entry = item.entries.front();
    const std::optional<std::size_t> type = find_block(entry.key);
    if (const EarlierBlock* const earlier = find_earlier_block(entry.key);
        earlier != nullptr && catalogue()[earlier->types.front()].info.station == station &&
        (!type || has_key_of_another(entry.value, *earlier, *type))) {
      read_earlier(entry, *earlier, model);
      return;
    }
    if (!type || catalogue()[*type].info.station != station) {
      report_unknown(entry, type, station);
      return;
    }
    const std::size_t before = problems_.size();
    MapReader map(document_, entry.value, problems_, entry.key);
    BlockSpec block = read_values(map, *type);
    map.finish();
    check_objection(entry, block, before);
    add(entry, std::move(block), model);
  }

  void add(const Node::Entry& entry, BlockSpec block, Model& model) {
    const BlockInfo& info = catalogue()[block.type].info;
    has_element_ = has_element_ || info.kind == Kind::element;
    check_place(entry, info, model);
    model.blocks.push_back(std::move(block));
  }

  /// Converts a block of an earlier version to the new blocks that have an effect with the values in the
  /// file. If none of the new blocks has an effect, the first new block is used.
  void read_earlier(const Node::Entry& entry, const EarlierBlock& earlier, Model& model) {
    MapReader map(document_, entry.value, problems_, entry.key);
    std::vector<std::size_t> types = earlier.types;
    if (!earlier.choice.empty()) {
      const auto last = static_cast<double>(types.size() - 1);
      types = {types[static_cast<std::size_t>(map.optional_integer(earlier.choice, {0, last}).value_or(0))]};
    }
    std::vector<BlockSpec> blocks;
    for (const std::size_t type : types) {
      BlockSpec block = read_values(map, type, type != types.front());
      if (type == types.front() || does_something(block)) blocks.push_back(std::move(block));
    }
    map.finish();
    if (blocks.size() > 1 && !does_something(blocks.front())) blocks.erase(blocks.begin());
    if (blocks.size() > 1 && !earlier.adds) report_several(entry, blocks);
    for (BlockSpec& block : blocks) add(entry, std::move(block), model);
  }

  void report_several(const Node::Entry& entry, const std::vector<BlockSpec>& blocks) {
    std::string hint =
        "the new blocks together do not have the same effect as the old block. Fit the model again with";
    for (const BlockSpec& block : blocks) {
      hint += " `- " + std::string(catalogue()[block.type].info.id) + ": {";
      for (std::size_t i = 0; i < block.values.size(); ++i)
        hint += (i == 0 ? "" : ", ") + parameter_name(block, i) + ": " + shortest(block.values[i]);
      hint += "}`";
    }
    problems_.add(document_.problem(
        entry.key_at, entry.key + " contains several mechanisms, which are separate blocks in this version",
        hint));
  }

  void report_unknown(const Node::Entry& entry, std::optional<std::size_t> type, Station station) {
    const std::string where(name_of(station));
    if (type) {
      problems_.add(document_.problem(
          entry.key_at, entry.key + " does not belong to the station " + where,
          "list this block under `" + std::string(name_of(catalogue()[*type].info.station)) + ":`"));
      return;
    }
    const std::string near = document::nearest(entry.key, ids_of(station));
    std::string hint = near.empty() ? "known here:" : "did you mean " + near + "?";
    if (near.empty()) {
      for (const std::string& id : ids_of(station)) hint += " " + id;
    }
    problems_.add(
        document_.problem(entry.key_at, "unknown block " + entry.key + " in the station " + where, hint));
  }

  // Checks the position of a block. The blocks of a station must be in the order of their kinds, and a block
  // that is not repeatable must occur only once.
  void check_place(const Node::Entry& entry, const BlockInfo& info, const Model& model) {
    for (const BlockSpec& block : model.blocks) {
      const BlockInfo& other = catalogue()[block.type].info;
      if (other.id == info.id && !info.repeatable) {
        const std::string id(info.id);
        problems_.add(document_.problem(
            entry.key_at, id + " occurs twice in the chain",
            info.formerly.empty() ? "" : std::string(info.formerly) + " is the deprecated name of " + id));
      }
      if (other.station == info.station && other.kind > info.kind) {
        problems_.add(document_.problem(
            entry.key_at, entry.key + " must be listed before " + std::string(other.id),
            "order within a station: pressure blocks, elements, displacement blocks, reading blocks"));
        return;
      }
    }
  }

  /// @param absent_is_neutral  true: a parameter that the file omits gets its neutral value.
  BlockSpec read_values(MapReader& map, std::size_t type, bool absent_is_neutral = false) {
    const BlockDescriptor& descriptor = catalogue()[type];
    const std::size_t parts = descriptor.repeated.empty() ? 0 : count_parts(map, descriptor);
    BlockSpec block = neutral_block(type, parts);
    for (std::size_t i = 0; i < block.values.size(); ++i) {
      const std::string name(map.name_in_use(descriptor.name(i), descriptor.former_name(i)));
      if (absent_is_neutral && map.child(name, false) == nullptr) continue;
      block.values[i] = read_value(map, descriptor.spec(i), name);
    }
    return block;
  }

  void check_objection(const Node::Entry& entry, const BlockSpec& block, std::size_t problems_before) {
    const BlockDescriptor& descriptor = catalogue()[block.type];
    if (problems_.size() != problems_before || descriptor.objection == nullptr) return;
    const std::string_view objection = descriptor.objection(block.values);
    if (!objection.empty()) problems_.add(document_.problem(entry.key_at, std::string(objection)));
  }

  const Document& document_;
  Problems& problems_;
  bool has_element_ = false;
};

// Returns the text as a double-quoted YAML scalar.
std::string double_quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (byte < 0x20 || byte == 0x7f) {
      std::array<char, 8> code{};
      std::snprintf(code.data(), code.size(), "\\x%02x", byte);
      result += code.data();
    } else {
      result += c;
    }
  }
  return result + "\"";
}

}  // namespace

std::optional<Model> read_model(const Document& document, Problems& problems) {
  const std::size_t before = problems.size();
  Model model = ModelReader(document, problems).read();
  if (problems.size() != before) return std::nullopt;
  return model;
}

std::optional<Model> read_rig_model(const Document& document, Problems& problems) {
  std::optional<Model> model = read_model(document, problems);
  if (!model || model->output_unit == OutputUnit::mm) return model;
  const auto key = std::find_if(document.root.entries.begin(), document.root.entries.end(),
                                [](const Node::Entry& entry) { return entry.key == output_unit_key; });
  problems.add(document.problem(key->key_at,
                                "the output unit of the model is " +
                                    std::string(name_of(model->output_unit)) +
                                    ", but a rig measures and controls in mm",
                                "simulate, identify, validate and diagnose use this model. A rig needs a "
                                "model that was identified from logs in mm"));
  return std::nullopt;
}

namespace {

std::optional<Model> load(const std::string& path, Problems& problems,
                          std::optional<Model> (*read)(const Document&, Problems&)) {
  const std::size_t before = problems.size();
  const Document document = document::parse_file(path, problems);
  std::optional<Model> model = read(document, problems);
  return problems.size() == before ? model : std::nullopt;
}

}  // namespace

std::optional<Model> load_model(const std::string& path, Problems& problems) {
  return load(path, problems, read_model);
}

std::optional<Model> load_rig_model(const std::string& path, Problems& problems) {
  return load(path, problems, read_rig_model);
}

namespace {

/// Names of blocks and parameters in the text of a model.
enum class Names { present, deprecated };

std::string yaml_of(const Model& model, Names names) {
  const bool deprecated = names == Names::deprecated;
  std::string text = "name: " + double_quoted(model.name) + "\nsource: " + double_quoted(model.source) + "\n";
  if (model.output_unit != OutputUnit::mm)
    text += std::string(output_unit_key) + ": " + std::string(name_of(model.output_unit)) + "\n";
  for (const Station station : stations) {
    bool any = false;
    for (const BlockSpec& block : model.blocks) {
      const BlockInfo& info = catalogue()[block.type].info;
      if (info.station != station) continue;
      if (!any) text += std::string(name_of(station)) + ":\n";
      any = true;
      text += "  - " + std::string(deprecated && !info.formerly.empty() ? info.formerly : info.id) + ":\n";
      for (std::size_t i = 0; i < block.values.size(); ++i) {
        const BlockDescriptor& descriptor = catalogue()[block.type];
        const bool renamed = deprecated && !descriptor.spec(i).formerly.empty();
        text += "      " + (renamed ? descriptor.former_name(i) : descriptor.name(i)) + ": " +
                shortest(block.values[i]) + "\n";
      }
    }
  }
  return text;
}

}  // namespace

std::string to_yaml(const Model& model) {
  return yaml_of(model, Names::present);
}

std::string model_hash(const Model& model) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : yaml_of(model, Names::deprecated)) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  }
  std::array<char, 17> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(hash));
  return digits.data();
}

}  // namespace softgrip::model
