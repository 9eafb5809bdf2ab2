#include "rig/plc_file/settings.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "base/net/listener.h"

namespace softgrip::plc {

namespace {

using document::MapReader;
using document::Node;

constexpr std::string_view numeric_hint = "write an IPv4 or IPv6 address in digits, for example 192.168.1.20";

class SettingsReader {
 public:
  SettingsReader(const document::Document& document, document::Problems& problems)
      : document_(document), problems_(problems) {}

  Settings read() {
    MapReader top(document_, document_.root, problems_, "the file");
    settings_.name = top.text("name");
    settings_.socket = top.text("socket");
    if (const Node* const node = top.child("listen", true)) listen(*node);
    if (const Node* const node = top.child("master", true)) master(*node);
    for (const Node* const node : top.sequence("recipes", true)) recipe(*node);
    if (const Node* const node = top.child("registers", true))
      settings_.registers = read_register_map(document_, *node, problems_);
    return settings_;
  }

 private:
  void listen(const Node& node) {
    MapReader reader(document_, node, problems_, "listen");
    settings_.address = reader.text("address");
    if (reader.good("address") && !net::is_numeric(settings_.address))
      reader.report("address", "this is not a numeric address", std::string(numeric_hint));
    settings_.port = static_cast<std::uint16_t>(reader.integer("port", 0, 65535));
    for (const Node* const item : reader.sequence("allow", true)) {
      settings_.allow.push_back(item->scalar);
      if (item->kind != Node::Kind::scalar || !net::is_numeric(item->scalar))
        problems_.add(
            document_.problem(item->at, "this is not a numeric address", std::string(numeric_hint)));
    }
    settings_.max_masters =
        static_cast<std::size_t>(reader.optional_integer("max_masters", 1, 32).value_or(4));
    settings_.idle_s = reader.optional_number("idle_s", {1, 3600}).value_or(60);
    if (reader.good("address") && !net::is_loopback(settings_.address) && settings_.allow.empty()) {
      reader.report("allow", "other machines can reach this address, so the permitted clients must be listed",
                    "allow: [192.168.1.20]");
    }
  }

  void master(const Node& node) {
    MapReader reader(document_, node, problems_, "master");
    settings_.silence_s = reader.number("silence_s", {0.05, 60});
    settings_.when_silent =
        static_cast<Reaction>(reader.choice("when_silent", {"nothing", "stop", "vent", "release"}));
  }

  void recipe(const Node& node) {
    MapReader reader(document_, node, problems_, "a recipe");
    Recipe recipe;
    recipe.number = static_cast<std::uint16_t>(reader.integer("number", 1, 65535));
    recipe.sequence = reader.text("sequence");
    recipe.squeeze = parameter(reader, "squeeze", "_kpa");
    recipe.speed = parameter(reader, "speed", "_mm_per_s");
    recipe.displacement = parameter(reader, "displacement", "_mm");
    const bool twice = std::any_of(settings_.recipes.begin(), settings_.recipes.end(),
                                   [&](const Recipe& other) { return other.number == recipe.number; });
    if (twice)
      reader.report("number", fmt::format("another recipe already has the number {}", recipe.number));
    settings_.recipes.push_back(std::move(recipe));
  }

  /// Reads the name of the sequence's parameter that a register sets. This name must end with the unit of the
  /// register.
  static std::string parameter(MapReader& reader, std::string_view key, std::string_view ending) {
    std::string name = reader.optional_text(key).value_or("");
    if (!name.empty() && !name.ends_with(ending)) {
      reader.report(key,
                    fmt::format("the name of the parameter that `{}` sets must end with `{}`", key, ending));
    }
    return name;
  }

  const document::Document& document_;
  document::Problems& problems_;
  Settings settings_;
};

}  // namespace

Settings read_settings(const document::Document& document, document::Problems& problems) {
  return SettingsReader(document, problems).read();
}

std::optional<Settings> load_settings(const std::string& path, document::Problems& problems) {
  const document::Document document = document::parse_file(path, problems);
  if (!problems.empty()) return std::nullopt;
  Settings settings = read_settings(document, problems);
  if (!problems.empty()) return std::nullopt;
  return settings;
}

}  // namespace softgrip::plc
