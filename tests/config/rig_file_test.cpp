// Tests the values that are read from the shipped rig files. Also tests that a missing or wrong key causes an
// error.

#include "rig/rig_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

#include "base/clock.h"
#include "base/files.h"
#include "tests/support/files.h"

namespace softgrip::daemon::rig_file_test {
namespace {

using document::Document;
using document::Node;
using document::Problems;

std::string shipped(const std::string& name) {
  return std::string(SOFTGRIP_SOURCE_DIR) + "/config/" + name;
}

rig::RigFile loaded(const std::string& name) {
  Problems problems;
  std::optional<rig::RigFile> rig = rig::load_rig(shipped(name), problems);
  EXPECT_TRUE(rig.has_value()) << problems.format();
  return rig.value_or(rig::RigFile{});
}

TEST(RigFile, TheBenchRigHasTheValuesOfTheFile) {
  const rig::RigFile rig = loaded("rig_tcp.yaml");
  EXPECT_EQ(rig.name, "bench");
  EXPECT_EQ(rig.settings.rate_hz, 200);
  ASSERT_EQ(rig.settings.channels.size(), 2U);
  const control::ChannelSettings& left = rig.settings.channels[0];
  EXPECT_EQ(left.name, "left");
  EXPECT_EQ(left.model.name, "bench_twin");
  EXPECT_EQ(left.feedforward.kind, control::FeedforwardKind::full_model);
  EXPECT_DOUBLE_EQ(left.feedforward.extra_latency_s, 0.25 * 0.005);
  EXPECT_EQ(left.pid.anti_windup, control::AntiWindup::back_calculation);
  EXPECT_EQ(left.limits.pressure_max_kpa, 60);
  EXPECT_EQ(left.limits.slew_down_kpa_per_s, 600);
  EXPECT_EQ(left.limits.displacement_min_mm, -1);
  EXPECT_EQ(left.plausibility.max_age_s, 0.05);
  EXPECT_EQ(left.health.unfit_mm, 3);
  EXPECT_TRUE(left.pressure_measured);
  EXPECT_TRUE(left.displacement_used);
  EXPECT_EQ(rig.settings.safety.safe_action[2], control::SafeAction::hold);
  EXPECT_EQ(rig.settings.safety.safe_action[1], control::SafeAction::vent);
  EXPECT_TRUE(rig.settings.safety.board_vents_when_silent);
  EXPECT_EQ(rig.settings.faults.readback_cycles, 10U);
  EXPECT_EQ(rig.settings.rest_timeout_s, 10);
  EXPECT_EQ(rig.valves[1].range_max_kpa, 100);
  EXPECT_EQ(rig.valves[1].on_power_loss, rig::PowerLoss::vents);
  const auto& board = std::get<drivers::ModbusSettings>(rig.board);
  ASSERT_EQ(board.links.size(), 1U);
  EXPECT_EQ(std::get<drivers::TcpAddress>(board.links[0]), (drivers::TcpAddress{"127.0.0.1", 1502}));
  ASSERT_EQ(board.modules.size(), 1U);
  EXPECT_EQ(board.modules[0].map.name, "ADAM-6024");
  ASSERT_EQ(board.wiring.size(), 2U);
  EXPECT_EQ(board.wiring[1].valve.output, 1U);
  EXPECT_EQ(board.wiring[1].displacement.scaling, (drivers::TwoPoints{0, -5, 10, 45}));
  EXPECT_EQ(board.wiring[1].displacement.valid_max, 9.9);
  EXPECT_EQ(board.wiring[1].pressure->input, 5U);
  EXPECT_EQ(rig.reconnect.longest_pause, std::chrono::seconds(2));
  EXPECT_EQ(rig.real_time.cpus, (std::vector<int>{1}));
  EXPECT_EQ(rig.socket.mode, 0660U);
  EXPECT_EQ(rig.recorder.mode, rig::RecorderSettings::Mode::sequences);
  EXPECT_EQ(rig.inputs.size(), 3U);
  EXPECT_EQ(rig.seed, std::nullopt);
}

/// Reads rig.yaml with the text `from` replaced by `to`.
std::optional<rig::RigFile> read_replaced(const std::string& from, const std::string& to,
                                          Problems& problems) {
  std::string text = test::text_of(shipped("rig.yaml"));
  text.replace(text.find(from), from.size(), to);
  return rig::read_rig(document::parse(shipped("rig.yaml"), text, problems), problems);
}

TEST(RigFile, ADeprecatedKeyIsReadButRefusedBesideTheNewKey) {
  const std::string cycles = "  overrun_cycles: 0", folder = "sequence_directory: sequences";
  const std::string socket = ": {path: /tmp/second.sock, mode: \"0660\"}";
  for (const char* key : {"overrun_cycles", "slipped_cycles"}) {
    Problems problems;
    const auto rig = read_replaced(cycles, std::string("  ") + key + ": 7", problems);
    ASSERT_TRUE(rig) << problems.format();
    EXPECT_EQ(rig->settings.faults.overrun_cycles, 7U) << key;
  }
  for (const char* key : {"read_only", "look"}) {
    Problems problems;
    const auto rig = read_replaced(folder, folder + ", " + key + socket, problems);
    ASSERT_TRUE(rig) << problems.format();
    EXPECT_EQ(rig->socket.look.path, "/tmp/second.sock") << key;
  }
  Problems two_counts;
  EXPECT_FALSE(read_replaced(cycles, "  slipped_cycles: 7\n  overrun_cycles: 7", two_counts));
  EXPECT_NE(two_counts.format().find("`slipped_cycles` is the deprecated name of `overrun_cycles`"),
            std::string::npos)
      << two_counts.format();
  Problems two_sockets;
  EXPECT_FALSE(read_replaced(folder, folder + ", look" + socket + ", read_only" + socket, two_sockets));
  EXPECT_NE(two_sockets.format().find("`look` is the deprecated name of `read_only`"), std::string::npos)
      << two_sockets.format();
}

TEST(RigFile, TheSimulatedRigHasThePlantsOfTheFile) {
  const rig::RigFile rig = loaded("rig.yaml");
  const auto& board = std::get<simulation::SimulatedBoardSettings>(rig.board);
  ASSERT_EQ(board.channels.size(), 2U);
  EXPECT_EQ(board.channels[0].plant.model.name, "bench_twin");
  EXPECT_EQ(board.channels[0].plant.object->position_mm, 12);
  EXPECT_EQ(board.channels[0].plant.sample_time_s, 0.005);
  EXPECT_NE(board.channels[0].plant.seed, board.channels[1].plant.seed);
  EXPECT_EQ(board.channels[0].valve_max_kpa, 100);
  EXPECT_DOUBLE_EQ(board.channels[0].sensor_max_mm, 44.5);
  EXPECT_TRUE(board.channels[0].measures_pressure);
  EXPECT_EQ(board.watchdog_timeout_s, 0.5);
  EXPECT_EQ(rig.seed, 1U);
}

TEST(RigFile, AVacuumIsSimulatedWithinTheValveRange) {
  Problems parsing;
  Document document = document::parse_file(shipped("rig.yaml"), parsing);
  for (Node::Entry& entry : document.root.entries) {
    if (entry.key != "channel_defaults") continue;
    for (Node::Entry& part : entry.value.entries) {
      for (Node::Entry& key : part.value.entries) {
        if (key.key == "pressure_min_kpa") key.value.scalar = "-2";
        if (key.key == "range_kpa") key.value.items[0].scalar = "-60";
      }
    }
  }
  Problems problems;
  const auto rig = rig::read_rig(document, problems);
  ASSERT_TRUE(rig.has_value()) << problems.format();
  const auto& board = std::get<simulation::SimulatedBoardSettings>(rig->board);
  EXPECT_EQ(board.channels[1].valve_min_kpa, -60);
  EXPECT_EQ(board.channels[1].vented_kpa, 0)
      << "a vented channel has the rest pressure and not the lowest pressure";
  VirtualClock clock;
  simulation::SimulatedBoard simulated(board, clock);
  std::vector<model::Reading> readings(2);
  ASSERT_EQ(simulated.connect(std::chrono::seconds(1)), drivers::BusStatus::ok);
  EXPECT_EQ(simulated.exchange(std::vector<double>{-2, -2}, readings, std::chrono::seconds(1)),
            drivers::BusStatus::ok)
      << simulated.detail();
}

/// Replaces the given texts in a copy of a shipped rig file and reads the copy. Relative paths in the copy
/// refer to the folder of the shipped file.
rig::RigReading edited(const std::string& name, const std::vector<std::pair<std::string, std::string>>& edits,
                       Problems& problems) {
  Problems parsing;
  std::string text = document::parse_file(shipped(name), parsing).text;
  for (const auto& [old, now] : edits) {
    const std::size_t at = text.find(old);
    EXPECT_NE(at, std::string::npos) << old;
    if (at != std::string::npos) text.replace(at, old.size(), now);
  }
  return rig::read_rig_so_far(document::parse(shipped(name), text, problems), problems);
}

/// A folder tree with the layout of /sys that contains three converters. Two of the converters have the same
/// name.
class Converters : public ::testing::Test {
 protected:
  Converters() {
    add("iio:device0", "1-0061", "mcp4725");
    add("iio:device1", "1-0060", "mcp4725");
    add("iio:device2", "1-0048", "ads1115");
  }
  void add(const std::string& node, const std::string& address, const std::string& name) const {
    const std::filesystem::path folder = root_ / "hardware" / address / node;
    std::filesystem::create_directories(folder);
    std::filesystem::create_directory_symlink(folder, root_ / node);
    std::ofstream(folder / "name") << name << "\n";
  }
  /// Sets the devices of the two valves in a copy of the shipped rig file to `first` and `second`. Returns
  /// the problems of the copy.
  [[nodiscard]] std::string problems_of(const std::string& first, const std::string& second) const {
    Problems problems;
    const auto reading = edited("rig_iio.yaml",
                                {{"  iio:\n", "  iio:\n    root: " + root_.string() + "\n"},
                                 {"device: 1-0060", "device: " + first},
                                 {"device: 1-0061", "device: " + second}},
                                problems);
    EXPECT_EQ(reading.accepted, problems.empty());
    return problems.format();
  }

  const ScratchFolder scratch_;
  const std::filesystem::path root_ = std::filesystem::canonical(scratch_.path());
};

TEST_F(Converters, AnAmbiguousConverterNameIsRefusedWithFileAndLine) {
  const std::string problems = problems_of("mcp4725", "mcp4725");
  for (const char* const said :
       {"rig_iio.yaml:11:18: ", "rig_iio.yaml:12:18: ",
        "`mcp4725` fits 2 converters: iio:device0 (name `mcp4725`, address `1-0061`) and iio:device1 (name "
        "`mcp4725`, address `1-0060`)",
        "write `1-0061` or `1-0060`"}) {
    EXPECT_NE(problems.find(said), std::string::npos) << said << "\n" << problems;
  }
}

TEST_F(Converters, AreChosenByAddressByNodeAndByPath) {
  EXPECT_EQ(problems_of("1-0060", "1-0061"), "");
  EXPECT_EQ(problems_of("iio:device1", (root_ / "hardware/1-0061").string()), "");
  EXPECT_EQ(problems_of("1-0070", "1-0071"), "")
      << "device addresses of another computer are not checked on this computer";
}

TEST_F(Converters, AHeartbeatIsAWatchdogOnlyIfValvesVentWithoutPower) {
  const std::pair<std::string, std::string> heartbeat{
      "    exchange_deadline_s",
      "    heartbeat: {device: 1-0062, channel: voltage0, raw: [0, 4095], timeout_s: 0.5}\n    "
      "exchange_deadline_s"};
  const std::pair<std::string, std::string> not_accepted{"accept_no_watchdog", "#"};
  const std::pair<std::string, std::string> holds{"on_power_loss: vents", "on_power_loss: holds"};
  Problems problems;
  const auto reading = edited("rig_iio.yaml", {heartbeat, not_accepted}, problems);
  EXPECT_TRUE(reading.accepted) << problems.format();
  EXPECT_TRUE(reading.rig.settings.safety.board_vents_when_silent);
  const auto& heart = std::get<drivers::IioSettings>(reading.rig.board).heartbeat;
  ASSERT_TRUE(heart);
  EXPECT_EQ(heart->second, 4095);
  EXPECT_EQ(heart->timeout_s, 0.5);
  EXPECT_FALSE(edited("rig_iio.yaml", {not_accepted}, problems).accepted);
  EXPECT_FALSE(edited("rig_iio.yaml", {heartbeat, not_accepted, holds}, problems).accepted)
      << "these valves keep their pressure without power, so the heartbeat does not make the board vent";
}

TEST_F(Converters, APressureSensorCanBeReadInKilopascals) {
  Problems problems;
  const auto reading = edited(
      "rig_iio.yaml",
      {{"device: ads1115, channel: voltage2", "device: hsc030, channel: pressure"},
       {"pressure_monitor: {input: 2}",
        "pressure_monitor: {input: 2, at_kpa: [101.3, 201.3], valid_kpa: [90, 250]}"},
       {"  pressure_monitor: {at_v: [0, 5], is_kpa: [0, 100], valid_v: [-0.1, 5]}",
        "  pressure_monitor: {is_kpa: [0, 100]}"},
       {"pressure_monitor: {input: 3}", "pressure_monitor: {input: 3, at_v: [0, 5], valid_v: [-0.1, 5]}"}},
      problems);
  ASSERT_TRUE(reading.accepted) << problems.format();
  EXPECT_EQ(reading.rig.wiring[0].pressure->unit, drivers::ElectricalUnit::kilopascal);
  EXPECT_EQ(reading.rig.wiring[0].pressure->valid_max, 250);
}

TEST_F(Converters, AConverterChannelListedTwiceIsRefused) {
  for (const auto& [first, second] : {std::pair{"1-0060", "iio:device1"}, {"other", "other"}}) {
    EXPECT_NE(problems_of(first, second).find("is already listed at 11:10"), std::string::npos)
        << first << "\n"
        << problems_of(first, second);
  }
}

TEST(RestPressure, IsReadPerChannelAndIsZeroByDefault) {
  for (const char* const name : {"rig.yaml", "vacuum/rig.yaml", "vacuum/rig_tcp.yaml"}) {
    const rig::RigFile rig = loaded(name);
    for (const control::ChannelSettings& channel : rig.settings.channels)
      EXPECT_EQ(control::resting_kpa(channel.limits), 0) << name;
    EXPECT_TRUE(rig.settings.safety.board_vents_when_silent) << name;
  }
  Problems problems;
  const auto own =
      edited("vacuum/rig.yaml", {{"  - name: right\n", "  - name: right\n    rest_kpa: -12\n"}}, problems);
  ASSERT_TRUE(own.accepted) << problems.format();
  EXPECT_EQ(control::resting_kpa(own.rig.settings.channels[0].limits), 0);
  EXPECT_EQ(control::resting_kpa(own.rig.settings.channels[1].limits), -12);
  const auto& board = std::get<simulation::SimulatedBoardSettings>(own.rig.board);
  EXPECT_EQ(board.channels[0].vented_kpa, 0);
  EXPECT_EQ(board.channels[1].vented_kpa, -12);
  const auto vacuum = edited("vacuum/rig.yaml",
                             {{"pressure_min_kpa: -40", "pressure_min_kpa: -80"},
                              {"pressure_max_kpa: 60", "pressure_max_kpa: -10"},
                              {"  rest_kpa: 0 ", "  rest_kpa: -10 "}},
                             problems);
  EXPECT_EQ(std::get<simulation::SimulatedBoardSettings>(vacuum.rig.board).channels[0].vented_kpa, 0)
      << "the board may vent to 0 kPa, because the limits of the channel do not apply to the board";
}

TEST(RestPressure, AValueBeyondTheLimitsIsRefusedWithTheRange) {
  for (const char* const beyond : {"-41", "60.5"}) {
    Problems problems;
    const auto rig =
        edited("vacuum/rig.yaml", {{"rest_kpa: 0", std::string("rest_kpa: ") + beyond}}, problems);
    EXPECT_FALSE(rig.accepted);
    const std::string text = problems.format();
    EXPECT_NE(
        text.find("vacuum/rig.yaml:27:13: `rest_kpa` must be in [-40, 60], the pressure limits of channel "
                  "`left`, found " +
                  std::string(beyond)),
        std::string::npos)
        << text;
  }
}

TEST(RestPressure, TheWatchdogPressureMustEqualTheRestPressure) {
  const std::string asked = "this board does not vent by itself when softgripd dies";
  for (const auto& [old, now, said] :
       std::vector<std::array<std::string, 3>>{// an output of 0 V of this board sets full vacuum
                                               {"map: board.yaml", "map: ../boards/softgrip-sim.yaml",
                                                "the watchdog of the board sets channel `left` to -100 kPa, "
                                                "but the rest pressure of this channel is 0 kPa"},
                                               {"rest_kpa: 0", "rest_kpa: 10",
                                                "the watchdog of the board sets channel `left` to 0 kPa, but "
                                                "the rest pressure of this channel is 10 kPa"}}) {
    Problems problems;
    EXPECT_FALSE(edited("vacuum/rig_tcp.yaml", {{old, now}}, problems).accepted);
    EXPECT_NE(problems.format().find(asked), std::string::npos) << problems.format();
    EXPECT_NE(problems.format().find(said), std::string::npos) << problems.format();
  }
  Problems problems;
  EXPECT_TRUE(edited("vacuum/rig_tcp.yaml", {{"rest_kpa: 0", "rest_kpa: 0.9"}}, problems).accepted)
      << "the difference from the rest pressure is within 1 % of the valve range, so the rig must be "
         "accepted: "
      << problems.format();
}

// The limits of the channel apply to the daemon, but not to the board. The board can therefore set a pressure
// beyond these limits, up to the range of the valve.
TEST(RestPressure, TheWatchdogPressureIsBoundedByTheValveRangeOnly) {
  using Edits = std::vector<std::pair<std::string, std::string>>;
  const auto with = [](Edits edits, const Edits& more) {
    edits.insert(edits.end(), more.begin(), more.end());
    return edits;
  };
  const Edits vacuum{{"pressure_min_kpa: -40", "pressure_min_kpa: -80"},
                     {"pressure_max_kpa: 60", "pressure_max_kpa: -10"},
                     {"  rest_kpa: 0 ", "  rest_kpa: -10 "}};
  const Edits inflates{{"valve: {at_v: [0, 10]", "valve: {at_v: [0, 5]"}};  // 5 V set the valve to 100 kPa
  const Edits no_pressure{{"range_kpa: [-100, 100]", "range_kpa: [-100, 0]"}};
  for (const Edits& edits : {with(vacuum, inflates), with({{"rest_kpa: 0", "rest_kpa: 60"}}, inflates)}) {
    Problems problems;
    EXPECT_FALSE(edited("vacuum/rig_tcp.yaml", edits, problems).accepted);
    EXPECT_NE(problems.format().find("the watchdog of the board sets channel `left` to 100 kPa"),
              std::string::npos)
        << problems.format();
  }
  for (const Edits& edits : {vacuum, with(with(vacuum, inflates), no_pressure)}) {
    Problems problems;
    EXPECT_TRUE(edited("vacuum/rig_tcp.yaml", edits, problems).accepted)
        << "the valve cannot reach a pressure nearer to 0 kPa, so the rig must be accepted: "
        << problems.format();
  }
}

TEST(RestPressure, ADifferentPressureWithoutPowerCausesAWarning) {
  const auto warning = [](const std::string& name,
                          const std::vector<std::pair<std::string, std::string>>& edits) {
    Problems problems;
    EXPECT_TRUE(edited(name, edits, problems).accepted) << problems.format();
    std::string text;
    for (const document::Problem& problem : problems.warnings()) text += problem.message + "\n";
    return text;
  };
  const std::pair<std::string, std::string> holds{"on_power_loss: vents", "on_power_loss: holds"};
  EXPECT_EQ(warning("vacuum/rig.yaml", {}), "");
  EXPECT_NE(warning("vacuum/rig.yaml", {{"rest_kpa: 0", "rest_kpa: -20"}})
                .find("if the power fails, the valve of channel `left` goes to 0 kPa, but the rest pressure "
                      "is -20 kPa"),
            std::string::npos);
  EXPECT_NE(
      warning("vacuum/rig.yaml", {{"on_power_loss: vents", "on_power_loss: vents, on_power_loss_kpa: -80"}})
          .find("goes to -80 kPa, but the rest pressure is 0 kPa"),
      std::string::npos);
  EXPECT_NE(
      warning("vacuum/rig.yaml", {{"rest_kpa: 0", "rest_kpa: -40"},
                                  {"on_power_loss: vents", "on_power_loss: vents, on_power_loss_kpa: -80"}})
          .find("goes to -80 kPa, but the rest pressure is -40 kPa"),
      std::string::npos)
      << "the pressure limits do not apply to a valve without power";
  EXPECT_NE(warning("vacuum/rig.yaml", {holds}).find("holds its last pressure"), std::string::npos);
  EXPECT_EQ(warning("rig.yaml", {holds}), "") << "the rig file does not state a rest pressure";
  Problems problems;
  EXPECT_FALSE(
      edited("rig.yaml", {{"on_power_loss: vents", "on_power_loss: holds, on_power_loss_kpa: 5"}}, problems)
          .accepted);
  EXPECT_NE(
      problems.format().find("with `on_power_loss: holds`, no other pressure on power loss is possible"),
      std::string::npos)
      << problems.format();
}

TEST(RigFile, AModelWithALagOrAGainBeyondTheLimitsOfAControllerIsRefused) {
  const ScratchFolder folder;
  const auto problems_with = [&](const std::string& old, const std::string& now) {
    std::string text = test::text_of(shipped("models/bench_twin.yaml"));
    text.replace(text.find(old), old.size(), now);
    std::ofstream(folder.path() + "/changed.yaml") << text;
    Problems problems;
    const std::pair<std::string, std::string> model{"models/bench_twin.yaml",
                                                    folder.path() + "/changed.yaml"};
    edited("rig.yaml", {model, model, model}, problems);  // the file names the model three times
    return problems.format();
  };
  const auto contains = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_FALSE(contains(problems_with("time_constant_s: 0.044", "time_constant_s: 10"), "controller allows"));
  const std::string slow = problems_with("time_constant_s: 0.044", "time_constant_s: 44");
  EXPECT_TRUE(contains(slow, "time_constant_s` of the model is 44 s, but a controller allows at most 10 s"))
      << slow;
  const std::string soft = problems_with("alpha_mm_per_kpa: 0.21105", "alpha_mm_per_kpa: 211");
  EXPECT_TRUE(contains(soft,
                       "alpha_mm_per_kpa` of the model is 211 mm/kPa, but a controller allows at most "
                       "10 mm/kPa"))
      << soft;
}

// A PID controller raises the pressure if the displacement is too small. If the gain of the finger is
// negative, the controller would raise the pressure to its upper limit.
TEST(RigFile, AModelWithoutAPositiveSettledGainIsRefusedWithAnyFeedforward) {
  const ScratchFolder folder;
  const auto problems_with = [&](const std::string& gain, const std::string& feedforward) {
    std::ofstream(folder.path() + "/modes.yaml")
        << "name: modes\nsource: test\nactuator:\n  - linear_modes: {direct_mm_per_kpa: "
           "0, "
           "period1_s: 0.2, damping_ratio1: 0.5, gain1_mm_per_kpa: "
        << gain << ", lead1_mm_per_kpa: 0}\n";
    Problems problems;
    const std::pair<std::string, std::string> model{"models/bench_twin.yaml", folder.path() + "/modes.yaml"};
    const std::pair<std::string, std::string> kind{"feedforward: full_model", "feedforward: " + feedforward};
    edited("rig.yaml", {model, model, model, kind}, problems);
    return problems.format();
  };
  const std::string refused = "but a controller requires a gain above 0";
  EXPECT_NE(problems_with("-0.3", "none").find(refused), std::string::npos) << problems_with("-0.3", "none");
  EXPECT_NE(problems_with("-0.3", "planned").find(refused), std::string::npos);
  EXPECT_NE(problems_with("0", "none").find("the finger does not stay deflected"), std::string::npos);
  EXPECT_EQ(problems_with("0.3", "none").find(refused), std::string::npos) << problems_with("0.3", "none");
  EXPECT_NE(problems_with("0.3", "full_model").find("`linear_modes`, which has no inverse"),
            std::string::npos);
}

TEST(RigFile, OnlyTheSettledGainOfLinearModesIsLimited) {
  const ScratchFolder folder;
  const auto problems_with = [&](const std::string& second_gain) {
    std::ofstream(folder.path() + "/opposite.yaml")
        << "name: opposite\nsource: test\nactuator:\n  - linear_modes: {direct_mm_per_kpa: 0, "
           "period1_s: 0.2, damping_ratio1: 1, gain1_mm_per_kpa: 12, lead1_mm_per_kpa: 11, "
           "period2_s: 0.21, damping_ratio2: 1, gain2_mm_per_kpa: "
        << second_gain << ", lead2_mm_per_kpa: -11}\n";
    Problems problems;
    const std::pair<std::string, std::string> model{"models/bench_twin.yaml",
                                                    folder.path() + "/opposite.yaml"};
    edited("rig.yaml", {model, model, model}, problems);
    return problems.format();
  };
  EXPECT_EQ(problems_with("-11.7").find("controller allows"), std::string::npos) << problems_with("-11.7");
  EXPECT_NE(problems_with("-1").find("the settled gain of `linear_modes` of the model is 11 mm/kPa, but a "
                                     "controller allows at most 10 mm/kPa"),
            std::string::npos)
      << problems_with("-1");
}

TEST(RigFile, PathsAreRelativeToTheFile) {
  std::filesystem::current_path("/");
  const rig::RigFile rig = loaded("rig.yaml");
  EXPECT_EQ(rig.socket.sequence_directory, shipped("sequences"));
  EXPECT_EQ(rig.recorder.directory, "/tmp/softgrip-runs");
  std::filesystem::current_path(shipped(""));
  Problems problems;
  const auto here = rig::load_rig("rig.yaml", problems);
  ASSERT_TRUE(here.has_value()) << problems.format();
  EXPECT_EQ(here->socket.sequence_directory, "sequences");
}

TEST(RigFile, ARateBeyondTheBusBudgetIsRefusedUnlessAccepted) {
  Problems parsing;
  Document document = document::parse_file(shipped("rig_tcp.yaml"), parsing);
  for (Node::Entry& entry : document.root.entries) {
    if (entry.key == "rate_hz") entry.value.scalar = "5000";
  }
  Problems problems;
  EXPECT_FALSE(rig::read_rig(document, problems).has_value());
  EXPECT_NE(problems.format().find("the bus is not fast enough for 5000 exchanges a second"),
            std::string::npos)
      << problems.format();
  Node yes;
  yes.kind = Node::Kind::scalar;
  yes.scalar = "true";
  document.root.entries[2].value.entries[0].value.entries.push_back({"accept_over_budget", {}, yes});
  Problems accepted;
  const auto rig = rig::read_rig(document, accepted);
  ASSERT_TRUE(rig.has_value()) << accepted.format();
  EXPECT_TRUE(rig->accept_over_budget);
}

/// Function type for for_each_entry(). That function calls `use(owner, index, path)` for each entry of `node`
/// and of all maps below it.
using Use = std::function<void(Node&, std::size_t, const std::string&)>;
void for_each_entry(Node& node, const std::string& path, const Use& use) {
  for (std::size_t i = 0; i < node.entries.size(); ++i) {
    const std::string below = path + node.entries[i].key;
    use(node, i, below);
    for_each_entry(node.entries[i].value, below + ".", use);
  }
  for (Node& item : node.items) for_each_entry(item, path + "-.", use);
}

/// Reads a document. Returns the problems if the document is refused, and nullopt if it is accepted.
std::optional<std::string> refusal(const Document& document) {
  Problems problems;
  if (rig::read_rig(document, problems)) return std::nullopt;
  return problems.format();
}

/// Returns true if the text of a problem names the key of the entry or a key below the entry. A key below the
/// entry suffices because several channels can share the entry.
bool is_named(const Node::Entry& entry, const std::string& text) {
  return text.find("`" + entry.key + "`") != std::string::npos ||
         std::any_of(entry.value.entries.begin(), entry.value.entries.end(),
                     [&](const Node::Entry& below) { return is_named(below, text); });
}

class EveryKey : public ::testing::TestWithParam<std::string> {
 protected:
  EveryKey() : document_(document::parse_file(shipped(GetParam()), problems_)) {}
  Problems problems_;
  Document document_;
};

TEST_P(EveryKey, IsRequiredOrListedAsOptional) {
  const std::set<std::string> optional{"board.simulated.plants.left.object",
                                       "board.simulated.plants.right.object", "faults.unsteady_is_fault",
                                       "real_time.cpu_dma_latency_us"};
  std::set<std::string> accepted;
  Node original = document_.root;
  for_each_entry(original, "", [&](Node& owner, std::size_t index, const std::string& path) {
    const Node::Entry taken = owner.entries[index];
    owner.entries.erase(owner.entries.begin() + static_cast<std::ptrdiff_t>(index));
    document_.root = original;
    const auto refused = refusal(document_);
    owner.entries.insert(owner.entries.begin() + static_cast<std::ptrdiff_t>(index), taken);
    if (!refused) {
      accepted.insert(path);
    } else {
      EXPECT_TRUE(is_named(taken, *refused)) << path << "\n" << *refused;
    }
  });
  for (const std::string& path : accepted) EXPECT_TRUE(optional.contains(path)) << path;
}

TEST_P(EveryKey, IsRefusedWithAnInvalidValue) {
  Node original = document_.root;
  for_each_entry(original, "", [&](Node& owner, std::size_t index, const std::string& path) {
    const Node taken = owner.entries[index].value;
    Node nonsense;
    nonsense.kind = Node::Kind::scalar;
    nonsense.at = taken.at;
    nonsense.scalar = "non sense/..";
    // A key in this list accepts every text except an empty one, so its test uses an empty text.
    const std::set<std::string> free{"recorder.directory", "socket.path", "socket.sequence_directory"};
    if (free.contains(path)) nonsense.scalar.clear();
    owner.entries[index].value = nonsense;
    document_.root = original;
    Problems problems;
    EXPECT_FALSE(rig::read_rig(document_, problems).has_value()) << path;
    const auto there = [&](const document::Problem& problem) { return problem.at == taken.at; };
    EXPECT_TRUE(std::any_of(problems.list().begin(), problems.list().end(), there)) << path << "\n"
                                                                                    << problems.format();
    owner.entries[index].value = taken;
  });
}

TEST_P(EveryKey, IsRefusedIfTheNameIsUnknown) {
  Node original = document_.root;
  for_each_entry(original, "", [&](Node& owner, std::size_t index, const std::string& path) {
    const std::string taken = owner.entries[index].key;
    owner.entries[index].key += "_x";
    document_.root = original;
    const auto refused = refusal(document_);
    ASSERT_TRUE(refused.has_value()) << path;
    EXPECT_NE(refused->find("unknown key `" + taken + "_x`"), std::string::npos) << path << "\n" << *refused;
    owner.entries[index].key = taken;
  });
}

INSTANTIATE_TEST_SUITE_P(Of, EveryKey, ::testing::Values("rig.yaml", "rig_tcp.yaml"),
                         [](const auto& parameter) {
                           return parameter.param == "rig.yaml" ? "simulated" : "modbus";
                         });

}  // namespace
}  // namespace softgrip::daemon::rig_file_test
