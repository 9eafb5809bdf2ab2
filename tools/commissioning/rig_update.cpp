#include "tools/commissioning/calibration_results.h"

#include <cmath>
#include <ctime>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "base/files.h"
#include "document/edit.h"
#include "rig/board_map_file.h"
#include "rig/rig_file.h"

namespace softgrip::tools::calibrate {
namespace {

using document::Node;

constexpr std::size_t most_bytes = 256 * 1024;
constexpr std::string_view mark = "# softgrip calibrate";

/// Data to replace the calibration points in one YAML map of the rig file, for example in the map `sensor` of
/// a channel.
struct Target {
  std::string map;  ///< key of the map, for example "sensor"
  std::string is;   ///< key of the values in the map, for example "is_mm"
  drivers::ElectricalUnit unit = drivers::ElectricalUnit::volt;
  const Line* line = nullptr;
};

std::vector<Target> targets_of(const rig::RigFile& rig, const Results& results) {
  const drivers::ChannelWiring& wiring = rig.wiring[results.channel];
  std::vector<Target> targets;
  if (results.valve) targets.push_back({"valve", "is_kpa", wiring.valve.unit, &results.valve->valve});
  if (results.valve && results.valve->monitor && wiring.pressure) {
    targets.push_back({"pressure_monitor", "is_kpa", wiring.pressure->unit, &*results.valve->monitor});
  }
  if (results.sensor) targets.push_back({"sensor", "is_mm", wiring.displacement.unit, &*results.sensor});
  return targets;
}

/// Returns the map `map` of the channel. If the rig has a single channel, this map may be in
/// `channel_defaults`.
const Node::Entry* map_of(const document::Document& document, std::size_t channel, const std::string& map) {
  const Node* const channels = document::below(&document.root, {"channels"});
  if (channels == nullptr || channel >= channels->items.size()) return nullptr;
  if (const Node::Entry* const own = document::entry_of(&channels->items[channel], map)) return own;
  if (channels->items.size() > 1) return nullptr;
  return document::entry_of(document::below(&document.root, {"channel_defaults"}), map);
}

bool set_pair(document::Edit& edit, const Node& map, const std::string& key, const PairText& pair) {
  if (const Node* const list = document::below(&map, {key})) {
    return edit.replace_numbers(*list, {pair.first, pair.second});
  }
  return edit.add_key(map, key, "[" + pair.first + ", " + pair.second + "]");
}

bool set_points(document::Edit& edit, const Node::Entry& entry, const Target& target,
                const Results& results) {
  const LineText points = text_of(target.line->points);
  if (!set_pair(edit, entry.value, "at" + std::string(rig::suffix_of(target.unit)), points.at)) return false;
  if (!set_pair(edit, entry.value, target.is, points.is)) return false;
  const std::string unit = target.is == "is_mm" ? "mm" : "kPa";
  edit.comment_above(entry, mark,
                     fmt::format("{} {}: error {} {}, noise of a reading {} {}", mark, results.date,
                                 rounded(target.line->error, 4), unit, rounded(target.line->noise, 4), unit));
  return true;
}

const drivers::TwoPoints* points_of(const drivers::ChannelWiring& wiring, const std::string& map) {
  if (map == "valve") return &wiring.valve.scaling;
  if (map == "sensor") return &wiring.displacement.scaling;
  return wiring.pressure ? &wiring.pressure->scaling : nullptr;
}

/// Returns true if the changed rig `now` contains the new points, and if all its other points equal the
/// points of the rig `before`.
bool says(const rig::RigFile& now, const rig::RigFile& before, const std::vector<Target>& targets,
          std::size_t channel) {
  if (now.wiring.size() != before.wiring.size()) return false;
  for (std::size_t i = 0; i < now.wiring.size(); ++i) {
    for (const std::string map : {"valve", "sensor", "pressure_monitor"}) {
      const drivers::TwoPoints* const is = points_of(now.wiring[i], map);
      const drivers::TwoPoints* const was = points_of(before.wiring[i], map);
      if ((is == nullptr) != (was == nullptr)) return false;
      if (is == nullptr) continue;
      const drivers::TwoPoints* wanted = was;
      for (const Target& target : targets) {
        if (i == channel && target.map == map) wanted = &target.line->points;
      }
      for (const double x : {wanted->x0, wanted->x1}) {
        if (std::abs(is->y_at(x) - wanted->y_at(x)) > 1e-3) return false;
      }
    }
  }
  return true;
}

}  // namespace

tl::expected<std::string, std::string> updated_rig(const std::string& text, const rig::RigFile& rig,
                                                   const Results& results) {
  const std::string& channel = rig.settings.channels[results.channel].name;
  document::Problems problems;
  const document::Document document = document::parse(rig.path, text, problems);
  const std::vector<Target> targets = targets_of(rig, results);
  document::Edit edit(document);
  for (const Target& target : targets) {
    const Node::Entry* const entry = map_of(document, results.channel, target.map);
    if (entry == nullptr || !set_points(edit, *entry, target, results)) {
      return tl::unexpected("`" + target.map + "` of channel `" + channel +
                            "` is written in a form that softgrip cannot change");
    }
  }
  std::string changed = edit.text();
  const document::Document again = document::parse(rig.path, changed, problems);
  const auto read = rig::read_rig(again, problems);
  if (!read)
    return tl::unexpected("the rig file would be refused with the new lines, so it was not changed:\n" +
                          problems.format());
  if (!says(*read, rig, targets, results.channel)) {
    return tl::unexpected("the lines of channel `" + channel + "` cannot be changed in the file");
  }
  return changed;
}

tl::expected<std::string, std::string> write_rig(const rig::RigFile& rig, const std::string& text) {
  const auto now = read_file(rig.path, most_bytes);
  if (!now) return tl::unexpected(now.error());
  if (*now != rig.inputs.front().text) {
    return tl::unexpected(rig.path + " was changed while the calibration ran");
  }
  const std::time_t time = std::time(nullptr);
  std::tm date{};
  ::localtime_r(&time, &date);
  char stamp[24] = "";
  std::strftime(stamp, sizeof stamp, "%Y%m%d-%H%M%S", &date);
  const std::string backup = rig.path + "." + stamp + ".bak";
  if (const auto kept = create_file(backup, *now); !kept) return tl::unexpected(kept.error());
  if (const auto written = replace_file(rig.path, text); !written) {
    std::error_code ignored;
    std::filesystem::remove(backup, ignored);
    return tl::unexpected(written.error());
  }
  return backup;
}

}  // namespace softgrip::tools::calibrate
