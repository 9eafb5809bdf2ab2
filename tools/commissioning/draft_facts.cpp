#include "tools/commissioning/rig_draft.h"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <sstream>

#include <fmt/format.h>

#include "base/numbers.h"
#include "base/text.h"
#include "drivers/modbus/serial_port.h"
#include "model/file/model_file.h"
#include "rig/board_map_file.h"
#include "tools/command_line/input_files.h"
#include "tools/commissioning/procedure.h"

namespace softgrip::tools {
namespace {

using Question = Fact::Question;

std::vector<std::string> words_of(std::string text) {
  std::replace(text.begin(), text.end(), ';', ' ');
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

std::string unit_name(drivers::ElectricalUnit unit) {
  return std::string(drivers::name_of(unit));
}

/// Returns the names of the files in a configuration folder, without their extensions.
std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(configuration_path(folder), error)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Returns the names in brackets, or "" if the list is empty.
std::string in_brackets(const std::vector<std::string>& names) {
  return names.empty() ? "" : " (" + with_commas(names) + ")";
}

/// Returns the path for a word. The word is a path, or the name of a file in a configuration folder. Returns
/// "" if the word is neither of these.
std::string path_of(const std::string& word, const std::string& folder) {
  std::error_code error;
  if (std::filesystem::is_regular_file(word, error)) return word;
  const std::string named = configuration_path(folder + "/" + word + ".yaml");
  return std::filesystem::is_regular_file(named, error) ? named : "";
}

std::string unknown_name(const std::string& word, const std::string& folder) {
  const std::vector<std::string> names = names_in(folder);
  const std::string near = document::nearest(word, names);
  std::error_code error;
  const bool exists = std::filesystem::is_directory(configuration_path(folder), error);
  const std::string all = !exists         ? "this folder does not exist"
                          : names.empty() ? "the folder is empty"
                                          : "available: " + with_commas(names);
  const std::string hint = near.empty() ? all : "did you mean " + near + "?";
  return document::in_backticks(word) + " is neither a file nor a name in " + configuration_path(folder) +
         ": " + hint;
}

std::optional<int> whole(const std::string& text, int lowest, int highest) {
  int value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc{} || result.ptr != text.data() + text.size()) return std::nullopt;
  if (value < lowest || value > highest) return std::nullopt;
  return value;
}

std::optional<std::pair<double, double>> two_numbers(const std::string& text) {
  const std::vector<std::string> words = words_of(text);
  if (words.size() != 2) return std::nullopt;
  const auto first = calibrate::typed_number(words[0]);
  const auto second = calibrate::typed_number(words[1]);
  if (!first || !second || *first == *second) return std::nullopt;
  return std::pair{*first, *second};
}

// --- Questions about the values of a draft, and checks of their answers

std::optional<Question> ask_board(const RigDraft&) {
  return Question{"one or more board maps; each is a file or a name in config/boards" +
                      in_brackets(names_in("boards")) + ", or `simulated`",
                  ""};
}

std::string take_board(const std::string& text, RigDraft& draft) {
  draft.modules.clear();
  const std::vector<std::string> words = words_of(text);
  if (words.empty()) return "at least one board map is required";
  if (words.size() == 1 && words.front() == "simulated") return "";
  for (const std::string& word : words) {
    const std::string path = path_of(word, "boards");
    if (path.empty()) return unknown_name(word, "boards");
    document::Problems problems;
    const auto map = rig::load_board_map(path, problems);
    if (!map) return problems.format();
    draft.modules.push_back({path, *map});
  }
  if (most_fingers(draft, false) == 0)
    return "valves need outputs and sensors need inputs: add a module with the missing terminals";
  return "";
}

std::optional<Question> ask_address(const RigDraft& draft) {
  if (draft.modules.empty()) return std::nullopt;
  return Question{
      "address of the board (192.168.1.20 or 192.168.1.20:502) or serial device (/dev/serial/by-id/...)", ""};
}

std::string take_address(const std::string& text, RigDraft& draft) {
  const std::vector<std::string> words = words_of(text);
  if (words.size() != 1) return "one address or one device is required";
  const std::string& word = words.front();
  if (word.front() == '/') {
    const auto unclear = drivers::unclear_serial_device(word);
    if (unclear && unclear->several) return unclear->message + ": " + unclear->hint;
    draft.device = word;
    draft.host.clear();
    return "";
  }
  const std::size_t colon = word.find(':') == word.rfind(':') ? word.find(':') : std::string::npos;
  std::array<unsigned char, sizeof(in6_addr)> address{};
  const std::string host = word.substr(0, colon);
  if (::inet_pton(AF_INET, host.c_str(), address.data()) != 1 &&
      ::inet_pton(AF_INET6, host.c_str(), address.data()) != 1) {
    return document::in_backticks(word) + " is neither a numeric address nor the path of a device" +
           (host == "localhost" ? ": write 127.0.0.1" : "");
  }
  const auto port = colon == std::string::npos ? std::optional(502) : whole(word.substr(colon + 1), 1, 65535);
  if (!port) return "a port must be from 1 to 65535";
  draft.host = host;
  draft.port = *port;
  draft.device.clear();
  return "";
}

std::optional<Question> ask_unit(const RigDraft& draft) {
  if (draft.modules.empty()) return std::nullopt;
  return Question{draft.modules.size() > 1
                      ? "unit id of the first module; the other modules have the next unit ids"
                      : "unit id of the board",
                  "1"};
}

std::string take_unit(const std::string& text, RigDraft& draft) {
  const bool serial = draft.host.empty();
  const auto unit = whole(text, serial ? 1 : 0, serial ? 247 : 255);
  if (!unit) return serial ? "a unit id must be from 1 to 247" : "a unit id must be from 0 to 255";
  draft.unit = *unit;
  return "";
}

std::optional<Question> ask_baud(const RigDraft& draft) {
  if (draft.modules.empty() || !draft.host.empty()) return std::nullopt;
  return Question{"the line's baud rate", "9600"};
}

std::string take_baud(const std::string& text, RigDraft& draft) {
  const auto baud = whole(text, 1200, 1'000'000);
  if (!baud) return "a baud rate must be from 1200 to 1000000";
  draft.baud = *baud;
  return "";
}

std::optional<Question> ask_fingers(const RigDraft&) {
  return Question{"names of the fingers", "left right"};
}

std::string take_fingers(const std::string& text, RigDraft& draft) {
  std::string spaced = text;
  std::replace(spaced.begin(), spaced.end(), ',', ' ');
  const std::vector<std::string> names = words_of(spaced);
  const auto good = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_';
  };
  if (names.empty()) return "a rig has at least one finger";
  for (const std::string& name : names) {
    if (name.size() > 32 || !std::all_of(name.begin(), name.end(), good)) {
      return document::in_backticks(name) + ": a name must consist of at most 32 letters, digits, `-` or `_`";
    }
    if (std::count(names.begin(), names.end(), name) > 1) return "two fingers have the name `" + name + "`";
  }
  if (names.size() > most_fingers(draft, false)) {
    return fmt::format("the board has terminals for {} fingers", most_fingers(draft, false));
  }
  draft.fingers = names;
  return "";
}

std::optional<Question> ask_model(const RigDraft&) {
  return Question{"model of the finger in free motion; a file or a name in config/models" +
                      in_brackets(names_in("models")),
                  "bench_twin"};
}

std::string take_model(const std::string& text, RigDraft& draft) {
  const std::string path = path_of(text, "models");
  if (path.empty()) return unknown_name(text, "models");
  document::Problems problems;
  const auto model = model::load_rig_model(path, problems);
  if (!model) return problems.format();
  draft.model = *model;
  draft.model_path = path;
  return "";
}

std::optional<Question> ask_valve(const RigDraft& draft) {
  const ElectricalRange range = output_range(draft);
  const bool told_kpa = output_unit(draft) == drivers::ElectricalUnit::kilopascal;
  return Question{fmt::format("pressures of the valve at the signals {} and {} {}, kPa", range.lowest,
                              range.highest, unit_name(output_unit(draft))),
                  told_kpa ? fmt::format("{} {}", range.lowest, range.highest) : "0 100"};
}

std::string take_valve(const std::string& text, RigDraft& draft) {
  const auto numbers = two_numbers(text);
  if (!numbers) return document::in_backticks(text) + ": enter two different pressures, for example 0 100";
  if (std::max(numbers->first, numbers->second) <= 0) return "at least one of the pressures must be above 0";
  if (numbers->first > numbers->second)
    return fmt::format(
        "{}: a valve without a signal must vent, so the lower pressure comes first. Enter {} {}",
        document::in_backticks(text), written(numbers->second), written(numbers->first));
  const ElectricalRange range = output_range(draft);
  draft.valve = {range.lowest, numbers->first, range.highest, numbers->second};
  return "";
}

std::optional<Question> ask_pressure_max(const RigDraft& draft) {
  const double highest = std::max(draft.valve.y0, draft.valve.y1);
  return Question{"highest permitted pressure of a finger, kPa", written(std::min(60.0, highest))};
}

std::string take_pressure_max(const std::string& text, RigDraft& draft) {
  const auto value = calibrate::typed_number(text);
  const double lowest = std::max(0.0, std::min(draft.valve.y0, draft.valve.y1));
  const double highest = std::max(draft.valve.y0, draft.valve.y1);
  if (!value || *value <= lowest || *value > highest) {
    return fmt::format("`{}`: must be above {} and at most {}, the range of the valve", document::shown(text),
                       written(lowest), written(highest));
  }
  draft.pressure_max_kpa = *value;
  return "";
}

std::optional<Question> ask_sensor(const RigDraft& draft) {
  const ElectricalRange range = input_range(draft);
  return Question{fmt::format("displacements of the sensor at the signals {} and {} {}, mm", range.lowest,
                              range.highest, unit_name(input_unit(draft))),
                  "-5 45"};
}

/// Smallest range of a sensor [mm]. The rig file states the limits of the displacement with a resolution of
/// 0.1 mm, so a smaller range is probably not in mm.
constexpr double least_sensor_range_mm = 1;

std::string take_sensor(const std::string& text, RigDraft& draft) {
  const auto numbers = two_numbers(text);
  if (!numbers)
    return document::in_backticks(text) + ": enter two different displacements, for example -5 45";
  if (std::abs(numbers->second - numbers->first) < least_sensor_range_mm)
    return fmt::format("{}: the displacements are in mm, and their difference must be at least {} mm",
                       document::in_backticks(text), written(least_sensor_range_mm));
  const ElectricalRange range = input_range(draft);
  draft.sensor = {range.lowest, numbers->first, range.highest, numbers->second};
  return "";
}

std::optional<Question> ask_monitor(const RigDraft& draft) {
  if (draft.fingers.size() > most_fingers(draft, true)) return std::nullopt;
  return Question{"is the pressure of each finger measured by the monitor output of its valve, yes or no",
                  "yes"};
}

std::string take_monitor(const std::string& text, RigDraft& draft) {
  if (text != "yes" && text != "y" && text != "no" && text != "n") return "yes or no";
  draft.monitor = text.front() == 'y';
  if (draft.monitor && draft.fingers.size() > most_fingers(draft, true)) {
    return "the board has no inputs left for pressure monitors";
  }
  return "";
}

std::optional<Question> ask_watchdog(const RigDraft& draft) {
  if (has_watchdog(draft)) return std::nullopt;
  return Question{
      "this board does not vent without communication: if softgripd fails, the board keeps the last "
      "pressures. Is this risk accepted, yes or no",
      ""};
}

std::string take_watchdog(const std::string& text, RigDraft& draft) {
  if (text != "yes" && text != "y")
    return "the rig is refused if the risk is not accepted: enter yes, or choose a different board (Ctrl-C "
           "ends)";
  draft.accepts_no_watchdog = true;
  return "";
}

}  // namespace

const std::vector<Fact>& draft_facts() {
  static const std::vector<Fact> facts{
      {"board",
       "Board map: a file, a name in config/boards, or `simulated`; give the option once for each module", 1,
       ask_board, take_board},
      {"address", "Numeric address with or without :PORT, or the path of a serial device", 1, ask_address,
       take_address},
      {"unit", "Unit id of the first module [1]", 1, ask_unit, take_unit},
      {"baud", "Baud rate of the serial line [9600]", 1, ask_baud, take_baud},
      {"finger", "Name of a finger; give the option once for each finger [left right]", 1, ask_fingers,
       take_fingers},
      {"model", "Model of the free motion of the finger: a file, or a name in config/models [bench_twin]", 1,
       ask_model, take_model},
      {"valve-kpa", "Pressures at the lower and the upper end of the valve's signal [0 100]", 2, ask_valve,
       take_valve},
      {"pressure-max-kpa", "Highest permitted pressure of a finger [60]", 1, ask_pressure_max,
       take_pressure_max},
      {"sensor-mm", "Displacements at the lower and the upper end of the sensor's signal [-5 45]", 2,
       ask_sensor, take_sensor},
      {"monitor",
       "`yes`: the monitor output of each valve, which measures the pressure, is wired to an input of the "
       "board. `no`: no pressure is measured [yes if the board has enough inputs]",
       1, ask_monitor, take_monitor},
      {"accept-no-watchdog", "`yes`: accept a board that does not vent without communication", 1,
       ask_watchdog, take_watchdog},
  };
  return facts;
}

}  // namespace softgrip::tools
