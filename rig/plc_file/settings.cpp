#include "rig/plc_file/settings.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "base/net/listener.h"
#include "document/schema.h"

namespace softgrip::plc {

namespace {

using document::MapReader;
using document::Node;
using document::optional;
using document::required;
using Keys = document::Keys<Settings>;

struct PlcKeys {
  Keys file, listen, master;
  document::Keys<Recipe> recipe;
};

const PlcKeys& plc_keys() {
  using S = Settings;
  static const PlcKeys keys{
      {required("name", &S::name, {}, "name that messages use for this file"),
       required("socket", &S::socket, {}, "path of the socket of softgripd"),
       {"listen", "map", "", "address of the server"},
       {"master", "map", "", "settings for the monitoring of the heartbeat of the Modbus client (master)"},
       {"recipes", "list", "", "sequences that the Modbus client (master) starts by number"},
       {"registers", "map", "",
        "map of the registers; you may change the address and the resolution of each register"}},
      {required("address", &S::address, {}, "numeric address on which softgrip-plc listens"),
       required("port", &S::port, {0, 65535}, "port of the server"),
       {"allow", "list", "", "numeric addresses of the masters that may connect"},
       optional("max_masters", &S::max_masters, {1, 32}, "largest number of [connections](#connections)"),
       optional("idle_s", &S::idle_s, {1, 3600},
                "time without a request after which softgrip-plc closes a connection")},
      {required("silence_s", &S::silence_s, {0.05, 60},
                "longest permitted time between two changes of the master's [heartbeat](#heartbeats)"),
       required("when_silent", &S::when_silent, reaction_names,
                "command that softgrip-plc sends to the daemon if the heartbeat of the master stops")},
      {required("number", &Recipe::number, {1, 65535}, "number with which the master selects the recipe"),
       required("sequence", &Recipe::sequence, {}, "name of the sequence in the daemon's sequence directory"),
       optional("squeeze", &Recipe::squeeze, {},
                "name of the sequence parameter (`..._kpa`) that the register `squeeze` sets"),
       optional("speed", &Recipe::speed, {},
                "name of the sequence parameter (`..._mm_per_s`) that the register `speed` sets"),
       optional("displacement", &Recipe::displacement, {},
                "name of the sequence parameter (`..._mm`) that the register `displacement` sets")}};
  return keys;
}

constexpr std::string_view numeric_hint = "write an IPv4 or IPv6 address in digits, for example 192.168.1.20";

class SettingsReader {
 public:
  SettingsReader(const document::Document& document, document::Problems& problems)
      : document_(document), problems_(problems) {}

  Settings read() {
    MapReader top(document_, document_.root, problems_, "the file");
    read_keys(top, plc_keys().file, settings_);
    read_map(top, "listen", true, plc_keys().listen, settings_, [this](MapReader& reader) { check(reader); });
    read_map(top, "master", true, plc_keys().master, settings_);
    for (const Node* const node : top.sequence("recipes", true)) recipe(*node);
    if (const Node* const node = top.child("registers", true))
      settings_.registers = read_register_map(document_, *node, problems_);
    return settings_;
  }

 private:
  /// Checks the addresses of the map `listen`.
  void check(MapReader& reader) {
    if (reader.good("address") && !net::is_numeric(settings_.address))
      reader.report("address", "this is not a numeric address", std::string(numeric_hint));
    for (const Node* const item : reader.sequence("allow", true)) {
      const std::string address = net::normal_address(item->scalar);
      const auto known = std::find(settings_.allow.begin(), settings_.allow.end(), address);
      if (known == settings_.allow.end()) settings_.allow.push_back(address);
      if (item->kind != Node::Kind::scalar || !net::is_numeric(item->scalar))
        problems_.add(
            document_.problem(item->at, "this is not a numeric address", std::string(numeric_hint)));
    }
    if (settings_.max_masters < settings_.allow.size()) {
      reader.report(reader.has("max_masters") ? "max_masters" : "allow",
                    fmt::format("{} addresses may connect, but `max_masters` is {}", settings_.allow.size(),
                                settings_.max_masters),
                    fmt::format("max_masters: {}", settings_.allow.size()));
    }
    if (reader.good("address") && !net::is_loopback(settings_.address) && settings_.allow.empty()) {
      reader.report("allow", "other machines can reach this address, so the permitted clients must be listed",
                    "allow: [192.168.1.20]");
    }
  }

  void recipe(const Node& node) {
    MapReader reader(document_, node, problems_, "a recipe");
    Recipe recipe;
    read_keys(reader, plc_keys().recipe, recipe);
    check_parameter(reader, "squeeze", recipe.squeeze, "_kpa");
    check_parameter(reader, "speed", recipe.speed, "_mm_per_s");
    check_parameter(reader, "displacement", recipe.displacement, "_mm");
    const bool twice = std::any_of(settings_.recipes.begin(), settings_.recipes.end(),
                                   [&](const Recipe& other) { return other.number == recipe.number; });
    if (twice)
      reader.report("number", fmt::format("another recipe already has the number {}", recipe.number));
    settings_.recipes.push_back(std::move(recipe));
  }

  /// Checks a parameter of the sequence that a register sets: the name of the parameter must end with the
  /// unit of the register.
  static void check_parameter(MapReader& reader, std::string_view key, const std::string& name,
                              std::string_view ending) {
    if (name.empty() || name.ends_with(ending)) return;
    reader.report(key,
                  fmt::format("the name of the parameter that `{}` sets must end with `{}`", key, ending));
  }

  const document::Document& document_;
  document::Problems& problems_;
  Settings settings_;
};

}  // namespace

std::vector<document::KeyFacts> file_keys() {
  std::vector<document::KeyFacts> facts;
  append_facts(facts, plc_keys().file);
  append_facts(facts, plc_keys().listen, "listen: ");
  append_facts(facts, plc_keys().master, "master: ");
  append_facts(facts, plc_keys().recipe, "recipes: ");
  return facts;
}

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
