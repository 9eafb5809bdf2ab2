#include "tools/plc/process_image.h"

#include <modbus/modbus.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "base/enum_table.h"

namespace softgrip::plc {

namespace {

using Json = nlohmann::ordered_json;

/// Names of the daemon's states in its JSON.
constexpr auto states = enum_names<StateCode>({{StateCode::no_daemon, ""},
                                               {StateCode::starting, "starting"},
                                               {StateCode::idle, "idle"},
                                               {StateCode::resynchronising, "resynchronising"},
                                               {StateCode::running, "running"},
                                               {StateCode::stopping, "stopping"},
                                               {StateCode::faulted, "faulted"}});
constexpr std::array<std::string_view, 6> results{"-",         "HOLDING",  "NO PART",
                                                  "PART LOST", "RELEASED", "ERROR"};

template <std::size_t N>
std::uint16_t index_of(const std::array<std::string_view, N>& words, std::string_view word) {
  const auto found = std::find(words.begin(), words.end(), word);
  return found == words.end() ? 0 : static_cast<std::uint16_t>(found - words.begin());
}

/// Returns the number that a code contains: 202 for "F202", 2 for "R02".
std::uint16_t number_in(std::string_view code) {
  std::uint16_t number = 0;
  if (!code.empty()) std::from_chars(code.data() + 1, code.data() + code.size(), number);
  return number;
}

/// Returns the quantity that a command register requests; nullopt if the register contains no value, so that
/// the default of the sequence applies.
std::optional<double> requested_value(std::uint16_t counts, double resolution) {
  if (counts == no_value) return std::nullopt;
  const auto number = static_cast<double>(static_cast<std::int16_t>(counts));
  // 0.01 has no exact binary value, so 460 * 0.01 is larger than 4.6. A division by 100 gives 4.6.
  const double per_unit = std::round(1 / resolution);
  return per_unit * resolution == 1 ? number / per_unit : number * resolution;
}

}  // namespace

modbus::Registers make_registers(const RegisterMap& map) {
  using Access = modbus::Registers::Access;
  modbus::Registers made;
  for (const RegisterInfo& info : registers()) {
    const bool quantity = !info.unit.empty();
    const bool written = info.block == Block::command;
    const std::size_t copies = info.block == Block::finger ? map.most_fingers : 1;
    for (std::size_t finger = 0; finger < copies; ++finger) {
      const std::uint16_t address =
          info.block == Block::finger ? map.at(info.name, finger) : map.at(info.name);
      made.define_holding(address, written ? Access::read_write : Access::read_only, quantity ? no_value : 0);
    }
  }
  made.set_holding(map.at(Name::map_version), version_of_map);
  for (const int function :
       {MODBUS_FC_READ_HOLDING_REGISTERS, MODBUS_FC_READ_INPUT_REGISTERS, MODBUS_FC_WRITE_SINGLE_REGISTER,
        MODBUS_FC_WRITE_MULTIPLE_REGISTERS, MODBUS_FC_WRITE_AND_READ_REGISTERS}) {
    made.allow(static_cast<std::uint8_t>(function));
  }
  return made;
}

std::uint16_t counts_of(const Json& value, double resolution) {
  if (!value.is_number()) return no_value;
  constexpr double most = std::numeric_limits<std::int16_t>::max();
  const double counts = std::clamp(std::round(value.get<double>() / resolution), -most, most);
  return static_cast<std::uint16_t>(static_cast<std::int16_t>(counts));
}

void write_status(const Json& status, const RegisterMap& map, modbus::Registers& to) {
  const Json& sequence = status["sequence"];
  const Json& fault = status["fault"];
  const Json& channels = status["channels"];
  const bool runs = sequence.is_object() && sequence["ended"].is_null();
  to.set_holding(map.at(Name::state),
                 static_cast<std::uint16_t>(
                     states.find(status["state"].get<std::string>()).value_or(StateCode::no_daemon)));
  to.set_holding(map.at(Name::result), index_of(results, status["result"].get<std::string>()));
  to.set_holding(map.at(Name::fault), fault.is_object() ? number_in(fault["code"].get<std::string>()) : 0);
  to.set_holding(map.at(Name::step),
                 runs ? static_cast<std::uint16_t>(sequence["step"].get<std::uint16_t>() + 1) : 0);
  const std::size_t fingers = std::min<std::size_t>(channels.size(), map.most_fingers);
  to.set_holding(map.at(Name::fingers), static_cast<std::uint16_t>(fingers));
  for (std::size_t i = 0; i < fingers; ++i) {
    const Json& channel = channels[i];
    const auto quantity = [&](Name name, const char* key) {
      to.set_holding(map.at(name, i), counts_of(channel[key], map.of_one(name)));
    };
    to.set_holding(map.at(Name::finger_result, i), index_of(results, channel["result"].get<std::string>()));
    quantity(Name::finger_displacement, "displacement_mm");
    quantity(Name::finger_pressure, "pressure_kpa");
    quantity(Name::finger_command, "command_kpa");
    quantity(Name::finger_squeeze, "squeeze_kpa");
    to.set_holding(map.at(Name::finger_valid, i), channel["validity"] == "valid" ? 1 : 0);
  }
}

void write_no_daemon(const RegisterMap& map, modbus::Registers& to) {
  for (const RegisterInfo& info : registers()) {
    for (std::size_t i = 0; info.block == Block::finger && i < map.most_fingers; ++i)
      to.set_holding(map.at(info.name, i), info.unit.empty() ? 0 : no_value);
  }
  for (const Name name : {Name::state, Name::result, Name::fault, Name::step, Name::fingers})
    to.set_holding(map.at(name), 0);
}

std::string_view command_of(CommandCode code) noexcept {
  static constexpr auto words = enum_names<CommandCode>({{CommandCode::none, ""},
                                                         {CommandCode::start, "start"},
                                                         {CommandCode::stop, "stop"},
                                                         {CommandCode::vent, "vent"},
                                                         {CommandCode::release, "release"},
                                                         {CommandCode::acknowledge, "acknowledge"}});
  return words[code];
}

tl::expected<Json, Reason> request_of(const Settings& settings, const Command& command) {
  if (command.code == 0 || command.code > last_command) return tl::unexpected(Reason::no_such_command);
  Json request{{"command", command_of(static_cast<CommandCode>(command.code))}};
  if (!command.is(CommandCode::start)) return request;
  const auto recipe = std::find_if(settings.recipes.begin(), settings.recipes.end(),
                                   [&](const Recipe& other) { return other.number == command.recipe; });
  if (recipe == settings.recipes.end()) return tl::unexpected(Reason::no_such_recipe);
  request["sequence"] = recipe->sequence;
  Json parameters = Json::object();
  const auto choose = [&](const std::string& parameter, Name name, std::uint16_t counts) {
    const auto value = requested_value(counts, settings.registers.of_one(name));
    if (!parameter.empty() && value) parameters[parameter] = *value;
  };
  choose(recipe->squeeze, Name::squeeze, command.squeeze);
  choose(recipe->speed, Name::speed, command.speed);
  choose(recipe->displacement, Name::displacement, command.displacement);
  if (!parameters.empty()) request["parameters"] = std::move(parameters);
  return request;
}

Reason reason_of(const Json& error) {
  const std::string code = error.value("code", "");
  if (code == "refused") {
    const std::uint16_t refusal = number_in(error.value("refusal", Json::object()).value("code", ""));
    return static_cast<Reason>(static_cast<std::uint16_t>(Reason::refusal) + refusal);
  }
  if (code == "sequence_refused") return Reason::sequence_refused;
  if (code == "owned" || code == "not_allowed") return Reason::not_allowed;
  if (code == "no_answer") return Reason::no_answer;
  return Reason::busy;
}

bool writes(std::span<const std::uint8_t> pdu, std::uint16_t address) noexcept {
  using modbus::word_at;
  if (pdu.size() < 5) return false;
  const auto within = [address](std::size_t first, std::size_t count) {
    return address >= first && address < first + count;
  };
  switch (pdu[0]) {
    case MODBUS_FC_WRITE_SINGLE_REGISTER:
      return within(word_at(pdu, 1), 1);
    case MODBUS_FC_WRITE_MULTIPLE_REGISTERS:
      return within(word_at(pdu, 1), word_at(pdu, 3));
    case MODBUS_FC_WRITE_AND_READ_REGISTERS:
      return pdu.size() >= 9 && within(word_at(pdu, 5), word_at(pdu, 7));
    default:
      return false;
  }
}

}  // namespace softgrip::plc
