#include "tools/plc/process_image.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace softgrip::plc::process_image_test {
namespace {

using Json = nlohmann::ordered_json;

Settings shipped() {
  document::Problems problems;
  return *load_settings(SOFTGRIP_SOURCE_DIR "/config/plc.yaml", problems);
}

class ProcessImage : public ::testing::Test {
 protected:
  std::uint16_t value(Name name) const { return registers_.holding(settings_.registers.at(name)); }
  std::uint16_t value(Name name, std::size_t finger) const {
    return registers_.holding(settings_.registers.at(name, finger));
  }

  Settings settings_ = shipped();
  modbus::Registers registers_ = make_registers(settings_.registers);
};

Json status() {
  return Json::parse(R"({
    "state": "running", "result": "PART LOST", "fault": {"code": "F202"},
    "sequence": {"step": 2, "ended": null},
    "channels": [
      {"result": "HOLDING", "displacement_mm": 12.345, "pressure_kpa": null, "command_kpa": 20.5,
       "squeeze_kpa": -0.5, "validity": "valid"},
      {"result": "PART LOST", "displacement_mm": null, "pressure_kpa": 1e6, "command_kpa": 0,
       "squeeze_kpa": null, "validity": "stale"}]})");
}

TEST_F(ProcessImage, WritesTheStatusToTheRegisters) {
  write_status(status(), settings_.registers, registers_);
  EXPECT_EQ(value(Name::map_version), version_of_map);
  EXPECT_EQ(value(Name::state), 4);
  EXPECT_EQ(value(Name::result), 3);
  EXPECT_EQ(value(Name::fault), 202);
  EXPECT_EQ(value(Name::step), 3);
  EXPECT_EQ(value(Name::fingers), 2);
  EXPECT_EQ(value(Name::finger_result, 0), 1);
  EXPECT_EQ(value(Name::finger_displacement, 0), 1235);
  EXPECT_EQ(value(Name::finger_pressure, 0), no_value);
  EXPECT_EQ(value(Name::finger_command, 0), 2050);
  EXPECT_EQ(static_cast<std::int16_t>(value(Name::finger_squeeze, 0)), -50);
  EXPECT_EQ(value(Name::finger_valid, 0), 1);
  EXPECT_EQ(value(Name::finger_displacement, 1), no_value);
  EXPECT_EQ(value(Name::finger_pressure, 1), 32767);
  EXPECT_EQ(value(Name::finger_valid, 1), 0);
}

TEST_F(ProcessImage, ClearsTheRegistersWithoutADaemon) {
  write_status(status(), settings_.registers, registers_);
  write_no_daemon(settings_.registers, registers_);
  EXPECT_EQ(value(Name::state), 0);
  EXPECT_EQ(value(Name::fingers), 0);
  EXPECT_EQ(value(Name::finger_result, 0), 0);
  EXPECT_EQ(value(Name::finger_displacement, 0), no_value);
}

TEST_F(ProcessImage, ACommandBecomesARequest) {
  Command command{1, 1};
  EXPECT_EQ(request_of(settings_, command)->dump(), R"({"command":"start","sequence":"pick_stone"})");
  command.squeeze = 425;
  command.speed = 500;  // the gateway must ignore the speed, because recipe 1 has no parameter for it
  EXPECT_EQ((*request_of(settings_, command))["parameters"].dump(), R"({"squeeze_kpa":4.25})");
  command.recipe = 99;
  EXPECT_EQ(request_of(settings_, command).error(), Reason::no_such_recipe);
  command.code = 3;
  EXPECT_EQ(request_of(settings_, command)->dump(), R"({"command":"vent"})");
  for (const int wrong : {0, 6, 65535}) {
    command.code = static_cast<std::uint16_t>(wrong);
    EXPECT_EQ(request_of(settings_, command).error(), Reason::no_such_command);
  }
}

TEST_F(ProcessImage, ConvertsARefusalToAReasonCode) {
  EXPECT_EQ(static_cast<int>(reason_of({{"code", "refused"}, {"refusal", {{"code", "R06"}}}})), 106);
  EXPECT_EQ(reason_of({{"code", "sequence_refused"}}), Reason::sequence_refused);
  EXPECT_EQ(reason_of({{"code", "owned"}}), Reason::not_allowed);
  EXPECT_EQ(reason_of({{"code", "busy"}}), Reason::busy);
}

TEST_F(ProcessImage, OnlyCommandRegistersAreWritable) {
  const auto written = [this](std::uint16_t address) {
    const modbus::Bytes pdu{6, static_cast<std::uint8_t>(address >> 8U), static_cast<std::uint8_t>(address),
                            0, 1};
    return registers_.answer(pdu).wrote;
  };
  EXPECT_TRUE(written(settings_.registers.at(Name::command)));
  EXPECT_FALSE(written(settings_.registers.at(Name::state)));
  EXPECT_FALSE(written(settings_.registers.at(Name::finger_result, 0)));
  EXPECT_FALSE(written(50));
}

TEST(Writes, FindsTheRegistersThatARequestWrites) {
  const modbus::Bytes single{6, 0, 5, 0, 1};
  EXPECT_TRUE(writes(single, 5));
  EXPECT_FALSE(writes(single, 4));
  const modbus::Bytes several{16, 0, 2, 0, 3, 6, 0, 0, 0, 0, 0, 0};
  EXPECT_TRUE(writes(several, 2));
  EXPECT_TRUE(writes(several, 4));
  EXPECT_FALSE(writes(several, 5));
  const modbus::Bytes both{23, 0, 100, 0, 1, 0, 7, 0, 1, 2, 0, 0};
  EXPECT_TRUE(writes(both, 7));
  EXPECT_FALSE(writes(both, 100));
  EXPECT_FALSE(writes(modbus::Bytes{3, 0, 5, 0, 1}, 5));
  EXPECT_FALSE(writes(modbus::Bytes{6}, 0));
}

/// The daemon compares the value with the limits of the sequence. Therefore, the value must be equal to the
/// decimal number that a sequence file contains.
TEST_F(ProcessImage, ARegisterValueEqualsItsDecimalNumber) {
  Command command;
  command.code = static_cast<std::uint16_t>(CommandCode::start);
  command.recipe = settings_.recipes[0].number;
  for (const auto& [resolution, decimals] : {std::pair{0.1, 1}, {0.01, 2}, {0.001, 3}, {0.5, 1}, {1.0, 0}}) {
    settings_.registers.resolution[static_cast<std::size_t>(Name::squeeze)] = resolution;
    for (int counts = 1; counts <= 32767; ++counts) {
      command.squeeze = static_cast<std::uint16_t>(counts);
      const auto request = request_of(settings_, command);
      ASSERT_TRUE(request);
      const std::string text = fmt::format("{:.{}f}", counts * resolution, decimals);
      ASSERT_EQ(request->at("parameters").at("squeeze_kpa").get<double>(), std::stod(text)) << text;
    }
  }
}

}  // namespace
}  // namespace softgrip::plc::process_image_test
