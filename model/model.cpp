#include "model/model.h"

#include <algorithm>
#include <cmath>

#include "base/numbers.h"
#include "model/catalogue.h"

namespace softgrip::model {
namespace {

// Returns a number that gives the order of the blocks: by station and, within a station, by kind.
int rank(const BlockInfo& info) {
  return static_cast<int>(info.station) * 8 + static_cast<int>(info.kind);
}

const BlockInfo& info_of(const BlockSpec& block) {
  return catalogue()[block.type].info;
}

void check_values(const BlockSpec& block, std::vector<std::string>& wrong) {
  const BlockDescriptor& descriptor = catalogue()[block.type];
  const std::string id(descriptor.info.id);
  if (!descriptor.accepts(block.values.size())) {
    wrong.push_back(id + " has " + std::to_string(block.values.size()) + " values");
    return;
  }
  const std::size_t before = wrong.size();
  for (std::size_t i = 0; i < block.values.size(); ++i) {
    const ParameterSpec& spec = descriptor.spec(i);
    const double value = block.values[i];
    if (!(value >= spec.lower && value <= spec.upper)) {
      wrong.push_back(id + "." + parameter_name(block, i) + " = " + shortest(value) + " is not in [" +
                      shortest(spec.lower) + ", " + shortest(spec.upper) + "]");
    } else if (spec.whole && value != std::round(value)) {
      wrong.push_back(id + "." + parameter_name(block, i) + " = " + shortest(value) +
                      " is not a whole number");
    }
  }
  if (wrong.size() != before || descriptor.objection == nullptr) return;
  const std::string_view objection = descriptor.objection(block.values);
  if (!objection.empty()) wrong.push_back(id + ": " + std::string(objection));
}

void check_order(const Model& model, std::vector<std::string>& wrong) {
  bool has_element = false;
  for (std::size_t i = 0; i < model.blocks.size(); ++i) {
    const BlockInfo& info = info_of(model.blocks[i]);
    has_element = has_element || info.kind == Kind::element;
    if (i > 0 && rank(info) < rank(info_of(model.blocks[i - 1]))) {
      wrong.push_back(std::string(info.id) + " must be listed before " +
                      std::string(info_of(model.blocks[i - 1]).id));
    }
    const bool again =
        std::any_of(model.blocks.begin(), model.blocks.begin() + static_cast<std::ptrdiff_t>(i),
                    [&](const BlockSpec& b) { return b.type == model.blocks[i].type; });
    if (again && !info.repeatable) wrong.push_back(std::string(info.id) + " occurs twice in the chain");
  }
  if (!has_element) wrong.emplace_back("the actuator has no element that turns pressure into displacement");
}

/// Returns the number of a block in paths: "_2" for the second block of a type, "" for the first block.
std::string number_in_path(const Model& model, std::size_t block) {
  const auto end = model.blocks.begin() + static_cast<std::ptrdiff_t>(block);
  const auto before = std::count_if(model.blocks.begin(), end, [&](const BlockSpec& other) {
    return other.type == model.blocks[block].type;
  });
  return before > 0 ? "_" + std::to_string(before + 1) : "";
}

}  // namespace

std::vector<std::string> validate(const Model& model) {
  std::vector<std::string> wrong;
  for (const BlockSpec& block : model.blocks) {
    if (block.type >= catalogue().size()) {
      return {"there is no block type " + std::to_string(block.type)};
    }
    check_values(block, wrong);
  }
  check_order(model, wrong);
  return wrong;
}

BlockSpec default_block(std::size_t type, std::size_t parts) {
  const BlockDescriptor& descriptor = catalogue()[type];
  BlockSpec block{type, {}};
  for (const ParameterSpec& spec : descriptor.parameters) block.values.push_back(spec.default_value);
  for (std::size_t part = 0; part < parts; ++part) {
    for (const ParameterSpec& spec : descriptor.repeated) block.values.push_back(spec.default_value);
  }
  return block;
}

BlockSpec neutral_block(std::size_t type, std::size_t parts) {
  BlockSpec block = default_block(type, parts);
  for (std::size_t i = 0; i < block.values.size(); ++i) {
    const double neutral = catalogue()[type].spec(i).neutral;
    if (!std::isnan(neutral)) block.values[i] = neutral;
  }
  return block;
}

Model with_block(Model model, BlockSpec block) {
  const auto place = [](const BlockSpec& b) { return std::pair(rank(info_of(b)), b.type); };
  const auto own = place(block);
  const auto behind = std::find_if(model.blocks.begin(), model.blocks.end(),
                                   [&](const BlockSpec& b) { return place(b) > own; });
  model.blocks.insert(behind, std::move(block));
  return model;
}

Model without_block(Model model, std::size_t type) {
  std::erase_if(model.blocks, [type](const BlockSpec& b) { return b.type == type; });
  return model;
}

Model only(Model model, bool (*keep)(const BlockInfo& info)) {
  std::erase_if(model.blocks, [keep](const BlockSpec& b) { return !keep(info_of(b)); });
  return model;
}

std::optional<std::size_t> position_of(const Model& model, std::size_t type) {
  for (std::size_t i = 0; i < model.blocks.size(); ++i) {
    if (model.blocks[i].type == type) return i;
  }
  return std::nullopt;
}

std::optional<std::size_t> position_of(const Model& model, std::string_view id) {
  const std::optional<std::size_t> type = find_block(id);
  return type ? position_of(model, *type) : std::nullopt;
}

std::string parameter_name(const BlockSpec& block, std::size_t index) {
  return catalogue()[block.type].name(index);
}

std::optional<std::size_t> find_parameter(const BlockSpec& block, std::string_view name) {
  for (std::size_t i = 0; i < block.values.size(); ++i) {
    if (catalogue()[block.type].is_named(i, name)) return i;
  }
  return std::nullopt;
}

std::size_t parameter_count(const Model& model) {
  std::size_t count = 0;
  for (const BlockSpec& block : model.blocks) count += block.values.size();
  return count;
}

ParameterPlace place_of(const Model& model, std::size_t flat_index) {
  ParameterPlace place{0, flat_index};
  while (place.value >= model.blocks[place.block].values.size()) {
    place.value -= model.blocks[place.block].values.size();
    ++place.block;
  }
  return place;
}

std::string parameter_path(const Model& model, std::size_t flat_index) {
  const ParameterPlace place = place_of(model, flat_index);
  const BlockSpec& block = model.blocks[place.block];
  return std::string(info_of(block).id) + number_in_path(model, place.block) + "." +
         parameter_name(block, place.value);
}

std::string former_path(const Model& model, std::size_t flat_index) {
  const ParameterPlace place = place_of(model, flat_index);
  const BlockDescriptor& descriptor = catalogue()[model.blocks[place.block].type];
  const std::string_view id = descriptor.info.formerly;
  const std::string name = descriptor.former_name(place.value);
  if (id.empty() && name.empty()) return "";
  return std::string(id.empty() ? descriptor.info.id : id) + number_in_path(model, place.block) + "." +
         (name.empty() ? descriptor.name(place.value) : name);
}

std::optional<std::size_t> find_path(const Model& model, std::string_view path) {
  const std::size_t dot = path.find('.');
  if (dot == std::string_view::npos) return std::nullopt;
  std::size_t flat_index = 0;
  for (std::size_t i = 0; i < model.blocks.size(); ++i) {
    const BlockSpec& block = model.blocks[i];
    const std::string number = number_in_path(model, i);
    std::string_view id = path.substr(0, dot);
    if (id.ends_with(number) && info_of(block).is_named(id.substr(0, id.size() - number.size()))) {
      if (const auto value = find_parameter(block, path.substr(dot + 1))) return flat_index + *value;
    }
    flat_index += block.values.size();
  }
  return std::nullopt;
}

const ParameterSpec& parameter_spec(const Model& model, std::size_t flat_index) {
  const ParameterPlace place = place_of(model, flat_index);
  return catalogue()[model.blocks[place.block].type].spec(place.value);
}

std::vector<double> flat_values(const Model& model) {
  std::vector<double> values;
  values.reserve(parameter_count(model));
  for (const BlockSpec& block : model.blocks)
    values.insert(values.end(), block.values.begin(), block.values.end());
  return values;
}

Model with_values(Model model, std::span<const double> values) {
  std::size_t next = 0;
  for (BlockSpec& block : model.blocks) {
    for (double& value : block.values) value = values[next++];
  }
  return model;
}

namespace {

bool is_part_of_a_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

void replace_word(std::string& text, std::string_view word, std::string_view by) {
  std::size_t at = text.find(word);
  while (at != std::string::npos) {
    const std::size_t end = at + word.size();
    const bool whole = (at == 0 || !is_part_of_a_word(text[at - 1])) &&
                       (end == text.size() || !is_part_of_a_word(text[end]));
    if (whole) text.replace(at, word.size(), by);
    at = text.find(word, whole ? at + by.size() : end);
  }
}

}  // namespace

std::string_view name_of(OutputUnit unit) noexcept {
  return unit == OutputUnit::deg ? "deg" : "mm";
}

std::string in_unit(std::string_view text, OutputUnit unit) {
  std::string result(text);
  if (unit == OutputUnit::mm) return result;
  replace_word(result, "mm", name_of(unit));
  replace_word(result, "displacement", "bending angle");
  return result;
}

}  // namespace softgrip::model
