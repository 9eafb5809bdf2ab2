#include "sysid/import/conversion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/numbers.h"
#include "base/text.h"
#include "sysid/import/proposal.h"
#include "sysid/import/samples.h"
#include "sysid/import/table_readers.h"

namespace softgrip::sysid::conversion_test {
namespace {

/// Returns a table of 200 samples in which the command rises and falls twice. `row` is a function that
/// returns one line of the table.
template <class Row>
std::string text_of(const std::string& header, Row row) {
  std::string text = header + "\n";
  for (int i = 0; i < 200; ++i) {
    const double p = 30 - std::abs(i % 100 - 50) * 0.6;
    text += row(i, p, 0.2 * p + 0.01 * i) + "\n";
  }
  return text;
}

std::string plain(int i, double p, double y) {
  return shortest(0.01 * i) + "," + shortest(p) + "," + shortest(y);
}

ForeignTable table_of(const std::string& text) {
  document::Problems problems;
  auto table = parse_text_table("t.csv", text, {}, problems);
  EXPECT_TRUE(table) << problems.format();
  return table ? *table : ForeignTable{};
}

ImportedLog log_of(const std::string& text, const Mapping& given = {}) {
  const ForeignTable table = table_of(text);
  document::Problems problems;
  auto result = convert(table, propose(table, given, true).mapping, problems);
  EXPECT_TRUE(result) << problems.format();
  return result ? *result : ImportedLog{};
}

std::string refusal(const std::string& text, const Mapping& mapping) {
  document::Problems problems;
  EXPECT_FALSE(convert(table_of(text), mapping, problems));
  return problems.format();
}

Mapping mapping_of(const char* time, const char* command, const char* displacement) {
  Mapping mapping;
  mapping[Role::time].columns = {time};
  mapping[Role::command].columns = {command};
  mapping[Role::displacement].columns = {displacement};
  return mapping;
}

TEST(Convert, AppliesUnitScaleAndZero) {
  const std::string text = text_of("t_ms,set_psi,laser_V", [](int i, double p, double y) {
    return shortest(10.0 * i) + "," + shortest(p) + "," + shortest(2 + y);
  });
  Mapping mapping = mapping_of("t_ms", "set_psi", "laser_V");
  mapping[Role::displacement].scale = -2;
  mapping[Role::displacement].zero = 2;
  const Log log = log_of(text, mapping).log;
  EXPECT_EQ(log.time_s[7], 0.07);
  EXPECT_NEAR(log.pressure_command_kpa[50], 30 * 6.894757293168361, 1e-9);
  EXPECT_NEAR(log.displacement_mm[50], -2 * 6.5, 1e-9);
}

TEST(Convert, MeanOfTwoColumnsConvertsEachColumnWithItsOwnUnit) {
  const std::string text = text_of("t_s,p1 (psi),p2 (kPa),x (mm),y (cm)", [](int i, double p, double y) {
    return shortest(0.01 * i) + "," + shortest(p / 6.894757293168361) + "," + shortest(p) + "," +
           shortest(y) + "," + shortest(y / 10);
  });
  for (const bool psi_first : {true, false}) {
    Mapping mapping = mapping_of("t_s", psi_first ? "p1 (psi)" : "p2 (kPa)", psi_first ? "x (mm)" : "y (cm)");
    mapping[Role::command].columns.emplace_back(psi_first ? "p2 (kPa)" : "p1 (psi)");
    mapping[Role::displacement].columns.emplace_back(psi_first ? "y (cm)" : "x (mm)");
    const Log log = log_of(text, mapping).log;
    ASSERT_EQ(log.size(), 200U);
    EXPECT_NEAR(log.pressure_command_kpa[50], 30, 1e-9);
    EXPECT_NEAR(log.displacement_mm[50], 6.5, 1e-9);
    const std::string shown = mapping_table(table_of(text), mapping);
    EXPECT_NE(shown.find("command in psi"), std::string::npos) << shown;
    EXPECT_NE(shown.find("command in kPa"), std::string::npos) << shown;
    EXPECT_EQ(unit_text(table_of(text), mapping[Role::command], Quantity::pressure),
              psi_first ? "psi, kPa" : "kPa, psi");
  }
}

TEST(Convert, MeanWithAColumnWithoutAUnitIsRefused) {
  Mapping mapping = mapping_of("t_s", "p1 (psi)", "x (mm)");
  mapping[Role::command].columns.emplace_back("p2");
  const std::string said =
      refusal(text_of("t_s,p1 (psi),p2,x (mm)",
                      [](int i, double p, double y) { return plain(i, p, p) + "," + shortest(y); }),
              mapping);
  EXPECT_NE(said.find("command: 'p2' has no unit"), std::string::npos) << said;
}

TEST(Convert, AnAngleMakesALogInDegrees) {
  for (const auto& [name, factor] :
       {std::pair("theta_deg", 1.0), std::pair("bend [rad]", 1 / model::deg_per_rad),
        std::pair("angle (\xc2\xb0)", 1.0)}) {
    const std::string text =
        text_of(std::string("time_s,set_kpa,") + name,
                [factor = factor](int i, double p, double y) { return plain(i, p, factor * y); });
    const Log log = log_of(text).log;
    EXPECT_EQ(log.output_unit, model::OutputUnit::deg) << name;
    EXPECT_NEAR(log.displacement_mm[50], 6.5, 1e-9) << name;
  }
}

TEST(Convert, DisplacementIsPreferredToAnAngle) {
  const Log log = log_of(text_of("time_s,set_kpa,angle_deg,tip_mm", [](int i, double p, double y) {
                    return plain(i, p, 3 * y) + "," + shortest(y);
                  })).log;
  EXPECT_EQ(log.output_unit, model::OutputUnit::mm);
  EXPECT_NEAR(log.displacement_mm[50], 6.5, 1e-9);
}

TEST(Convert, ScaledReadingsAreMillimetresUnlessAnAngleUnitIsGiven) {
  const std::string text = text_of("time_s,set_kpa,flex_V", plain);
  Mapping mapping = mapping_of("time_s", "set_kpa", "flex_V");
  mapping[Role::displacement].scale = 2;
  EXPECT_EQ(log_of(text, mapping).log.output_unit, model::OutputUnit::mm);
  mapping[Role::displacement].unit = "rad";
  const ImportedLog angle = log_of(text, mapping);
  EXPECT_EQ(angle.log.output_unit, model::OutputUnit::deg);
  EXPECT_NEAR(angle.log.displacement_mm[50], 2 * 6.5 * model::deg_per_rad, 1e-9);
  EXPECT_TRUE(angle.warnings.empty());
}

TEST(Convert, ATemperatureInDegreesIsNoAngle) {
  const std::string text = text_of("time_s,set_kpa,temp_deg", plain);
  EXPECT_NE(refusal(text, {}).find("a displacement or a bending angle"), std::string::npos);
}

TEST(Convert, ZeroFirstSubtractsTheFirstValue) {
  const std::string text =
      text_of("t_s,set_kpa,tip_mm", [](int i, double p, double y) { return plain(i, p, y + 5); });
  Mapping mapping = mapping_of("t_s", "set_kpa", "tip_mm");
  mapping[Role::displacement].zero_first = true;
  const Log log = log_of(text, mapping).log;
  EXPECT_EQ(log.displacement_mm[0], 0);
  EXPECT_NEAR(log.displacement_mm[50], 6.5, 1e-9);
}

TEST(Convert, ZeroFirstIsTheFirstValueOfTheColumnWithACutAtTheStart) {
  const std::string text =
      text_of("t_s,set_kpa,tip_mm", [](int i, double p, double y) { return plain(i, p, y + 5); });
  Mapping mapping = mapping_of("t_s", "set_kpa", "tip_mm");
  mapping[Role::displacement].zero_first = true;
  mapping.from_s = 0.5;
  const Log log = log_of(text, mapping).log;
  ASSERT_EQ(log.size(), 150U);
  EXPECT_NEAR(log.displacement_mm[0], 6.5, 1e-9);
}

TEST(Convert, GapsOfTheSamplingAreCounted) {
  for (const int gaps : {1, 2}) {
    const std::string text = text_of("t_s,set_kpa,tip_mm", [&](int i, double, double y) {
      const double late_s = i < 60 ? 0 : i < 120 || gaps == 1 ? 1 : 2;
      return shortest(0.01 * i + late_s) + "," + shortest((i + 15) / 30) + "," + shortest(y);
    });
    std::vector<std::string> notes;
    for (const LogNote& note : log_of(text, mapping_of("t_s", "set_kpa", "tip_mm")).log.notes)
      notes.push_back(note.text);
    const std::string expected =
        gaps == 1
            ? "1 gap in the sampling lasts 1.01 s; the command is assumed to be linear during this gap"
            : "2 gaps in the sampling; the longest gap lasts 1.01 s; the command is assumed to be linear "
              "during these gaps";
    EXPECT_EQ(std::ranges::count(notes, expected), 1)
        << with_commas(notes, [](const std::string& note) { return note; });
  }
}

TEST(Convert, EpochTimesKeepDoublePrecision) {
  const std::string text = text_of("timestamp,set_kpa,tip_mm", [](int i, double p, double y) {
    return fixed(1717156800 + 0.01 * i, 3) + "," + shortest(p) + "," + shortest(y);
  });
  const Log log = log_of(text).log;
  for (int i = 0; i < 200; ++i) EXPECT_EQ(log.time_s[static_cast<std::size_t>(i)], i / 100.0);
}

TEST(Convert, MeasuredPressureReplacesAMissingCommand) {
  const ImportedLog result = log_of(text_of("time_s,pressure_kpa,tip_mm", plain));
  EXPECT_EQ(result.log.pressure_command_kpa, result.log.pressure_kpa);
  EXPECT_NE(result.notes.back().find("the measured pressure is used instead"), std::string::npos);
}

TEST(Convert, ErrorsNameTheMissingOptions) {
  const std::string text = text_of("time_s,set,laser_V", plain);
  const std::string said = refusal(text, mapping_of("time_s", "sett", "laser_V"));
  EXPECT_NE(said.find("command: no column 'sett'"), std::string::npos) << said;
  EXPECT_NE(said.find("is 'set' meant?"), std::string::npos);
  EXPECT_NE(said.find("--scale displacement=X, mm per V"), std::string::npos);
  EXPECT_NE(refusal(text, mapping_of("time_s", "set", "laser_V")).find("--unit command=kPa"),
            std::string::npos);
  EXPECT_NE(refusal(text, {}).find("no column is assigned to the role time"), std::string::npos);
  EXPECT_NE(refusal(text_of("a,b,c", plain), {}).find("--rate-hz R"), std::string::npos);
}

TEST(Convert, InvalidResultLogIsRefused) {
  const std::string still =
      text_of("time_s,set_kpa,tip_mm", [](int i, double, double y) { return plain(i, 7, y); });
  EXPECT_NE(refusal(still, mapping_of("time_s", "set_kpa", "tip_mm"))
                .find("the result is not a valid log: the command is 7 kPa"),
            std::string::npos);
}

TEST(Convert, TooLargeCommandStatesTheUnitFromWhichItWasConverted) {
  const std::string text =
      text_of("time_s,set_bar,tip_mm", [](int i, double p, double y) { return plain(i, 3 * p, y); });
  const std::string said = refusal(text, mapping_of("time_s", "set_bar", "tip_mm"));
  EXPECT_NE(said.find(" kPa; the permitted magnitude is at most 5000 kPa"), std::string::npos) << said;
  EXPECT_NE(said.find("the command was converted from bar"), std::string::npos) << said;
  EXPECT_NE(said.find("--unit command=kPa"), std::string::npos) << said;
}

TEST(ForeignSamples, BackwardTimeIsReportedWithTheRow) {
  ForeignSamples samples;
  samples[Role::time] = {0, 1, 2, 1.5};
  samples[Role::displacement] = {0, 0, 0, 0};
  samples.row = {0, 1, 2, 3};
  ImportRemarks remarks;
  const auto problem = order_in_time({}, samples, remarks);
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->row, 3U);
}

TEST(ForeignSamples, FirstOfTwoSamplesWithEqualTimeIsKept) {
  ForeignSamples samples;
  samples[Role::time] = {10, 10.5, 10.5, std::nan(""), 11};
  samples[Role::displacement] = {1, 2, 3, 4, 5};
  samples.row = {0, 1, 2, 3, 4};
  ImportRemarks remarks;
  EXPECT_FALSE(order_in_time({}, samples, remarks));
  EXPECT_EQ(samples[Role::time], (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(samples[Role::displacement], (std::vector<double>{1, 2, 5}));
  EXPECT_EQ(remarks.notes.size(), 3U);
}

TEST(ForeignSamples, GapCutsTheLogOnlyIfTheCommandChanged) {
  for (const double change : {0.0, 30.0}) {
    ForeignSamples samples;
    for (int i = 0; i < 200; ++i) {
      samples[Role::time].push_back(0.01 * i + (i < 80 ? 0 : 2));
      samples[Role::command].push_back(i < 80 ? 10 : 10 + change);
      samples.row.push_back(static_cast<std::size_t>(i));
    }
    samples[Role::command].front() = 0;
    ImportRemarks remarks;
    cut_at_holes(samples, remarks);
    EXPECT_EQ(samples.size(), change > 0 ? 120U : 200U);
    EXPECT_EQ(samples.row.front(), change > 0 ? 80U : 0U);
    EXPECT_EQ(samples[Role::time].front(), 0);
  }
}

TEST(ForeignSamples, CommandsBetweenSlowReadingsAreKept) {
  ForeignSamples samples;
  for (int i = 0; i < 100; ++i) {
    samples[Role::time].push_back(0.01 * i);
    samples[Role::command].push_back(i == 50 ? std::nan("") : i);
    samples[Role::displacement].push_back(i % 10 == 0 ? i : std::nan(""));
    samples.row.push_back(static_cast<std::size_t>(i));
  }
  ImportRemarks remarks;
  complete_drive(samples, remarks);
  EXPECT_EQ(samples.size(), 100U);
  EXPECT_EQ(samples[Role::command][50], 49);
  EXPECT_TRUE(std::isnan(samples[Role::displacement][55]));
  EXPECT_EQ(remarks.notes.size(), 1U);
}

TEST(Propose, AssignsRolesByNameAndUnit) {
  const ForeignTable table = table_of(
      text_of("Zeit [ms],supply_bar,p_soll_bar,p_ist_bar,Temp (\xc2\xb0"
              "C),Weg [mm]",
              [](int i, double p, double y) {
                return shortest(10.0 * i) + ",7," + shortest(p) + "," + shortest(p) + ",21," + shortest(y);
              }));
  const Proposal proposal = propose(table, {}, true);
  EXPECT_TRUE(proposal.missing.empty());
  EXPECT_EQ(proposal.guessed.size(), 6U);
  EXPECT_EQ(options_of(proposal.mapping),
            "--time 'Zeit [ms]' --command p_soll_bar --pressure p_ist_bar --displacement 'Weg [mm]' "
            "--temperature 'Temp (\xc2\xb0"
            "C)' --supply supply_bar");
}

TEST(Propose, AnErrorIsNoMeasuredPressure) {
  const auto row = [](int i, double p, double y) { return plain(i, p, y) + "," + shortest(0.01 * p); };
  const Proposal both = propose(table_of(text_of("t_s,p_cmd_kpa,tip_mm,p_error_kpa", row)), {}, true);
  EXPECT_EQ(options_of(both.mapping), "--time t_s --command p_cmd_kpa --displacement tip_mm");
  const Proposal alone = propose(table_of(text_of("t_s,p_error_kpa,tip_mm", plain)), {}, true);
  ASSERT_EQ(alone.missing.size(), 1U);
  EXPECT_NE(alone.missing[0].find("('p_error_kpa' is not proposed"), std::string::npos) << alone.missing[0];
  Mapping given;
  given[Role::pressure].columns = {"p_error_kpa"};
  EXPECT_TRUE(propose(table_of(text_of("t_s,p_error_kpa,tip_mm", plain)), given, true).missing.empty());
}

TEST(Propose, TheDisplacementThatMovesIsPreferred) {
  const auto beside = [](const std::string& header, double factor) {
    return propose(table_of(text_of(header,
                                    [&](int i, double p, double y) {
                                      return shortest(0.01 * i) + "," + shortest(p) + "," +
                                             shortest(3 + factor * y) + "," + shortest(y);
                                    })),
                   {}, true);
  };
  const Proposal still = beside("t_s,p_cmd_kpa,x_mm,y_mm", 0);
  EXPECT_EQ(still.mapping[Role::displacement].columns, std::vector<std::string>{"y_mm"});
  ASSERT_EQ(still.warnings.size(), 1U);
  EXPECT_NE(still.warnings[0].find("the values of 'x_mm' do not"), std::string::npos) << still.warnings[0];
  const Proposal both = beside("t_s,p_cmd_kpa,x_mm,y_mm", 0.5);
  EXPECT_EQ(both.mapping[Role::displacement].columns, std::vector<std::string>{"x_mm"});
  ASSERT_EQ(both.warnings.size(), 1U);
  EXPECT_NE(both.warnings[0].find("'y_mm' fits and moves too"), std::string::npos) << both.warnings[0];
  const Proposal angle = beside("t_s,p_cmd_kpa,tip_mm,bend_deg", 0);
  EXPECT_EQ(angle.mapping[Role::displacement].columns, std::vector<std::string>{"bend_deg"});
  EXPECT_EQ(angle.warnings.size(), 1U);
  const Proposal ordinary = beside("t_s,p_cmd_kpa,tip_mm,bend_deg", 0.5);
  EXPECT_EQ(ordinary.mapping[Role::displacement].columns, std::vector<std::string>{"tip_mm"});
  EXPECT_TRUE(ordinary.warnings.empty());
}

TEST(Propose, AColumnWithoutAValueIsNotProposed) {
  const auto with = [](const std::string& cell) {
    return table_of(text_of("t_s,set_kpa,tip_mm,temp_C",
                            [&](int i, double p, double y) { return plain(i, p, y) + "," + cell; }));
  };
  Mapping coded;
  coded.missing = {"-999"};
  for (const Proposal& proposal : {propose(with(""), {}, true), propose(with("-999"), coded, true)}) {
    EXPECT_FALSE(proposal.mapping[Role::temperature].given());
    EXPECT_EQ(proposal.notes,
              std::vector<std::string>{"'temp_C' has no value, so it is not used as the temperature"});
  }
  const Proposal proposal = propose(table_of(text_of("t_s,set_kpa,pressure_kpa,tip_mm",
                                                     [](int i, double p, double) {
                                                       return shortest(0.01 * i) + ",," + shortest(p) + ",";
                                                     })),
                                    {}, true);
  EXPECT_FALSE(proposal.mapping[Role::command].given());
  EXPECT_EQ(proposal.mapping[Role::pressure].columns, std::vector<std::string>{"pressure_kpa"});
  ASSERT_EQ(proposal.missing.size(), 1U);
  EXPECT_NE(proposal.missing[0].find("--displacement COLUMN ('tip_mm' has no value)"), std::string::npos)
      << proposal.missing[0];
}

TEST(Propose, ARareCommandIsNoCode) {
  const ForeignTable table = table_of(text_of("t_s,set_kpa,pressure_kpa,tip_mm", [](int i, double, double y) {
    const std::string command = i % 20 == 7 ? "60" : std::to_string(i % 2);
    return shortest(0.01 * i) + "," + command + "," + command + "," + shortest(y);
  }));
  EXPECT_EQ(propose(table, {}, true).mapping.missing_in, (std::vector<ColumnCode>{{"pressure_kpa", 60}}));
}

TEST(Propose, KeepsGivenAssignments) {
  const ForeignTable table = table_of(text_of("t_s,p1_kpa,tip_mm", plain));
  Mapping given;
  given[Role::pressure].columns = {"p1_kpa"};
  const Proposal proposal = propose(table, given, true);
  EXPECT_FALSE(proposal.mapping[Role::command].given());
  EXPECT_EQ(proposal.guessed, (std::vector<Role>{Role::time, Role::displacement}));
}

/// Returns a text in which the two displacements begin at 500 mm and at 0 mm. Both displacements and the
/// command contain zeros, but only the zeros of the first displacement are codes.
std::string with_dropouts() {
  return text_of("t_s,p_cmd_kpa,x_mm,y_mm", [](int i, double p, double y) {
    return shortest(0.01 * i) + "," + shortest(p) + "," + (i % 40 == 7 ? "0" : shortest(500 + y)) + "," +
           shortest(y);
  });
}

TEST(Convert, CodesForMissingValuesApplyToTheirColumnOnly) {
  const ForeignTable table = table_of(with_dropouts());
  Mapping given = mapping_of("t_s", "p_cmd_kpa", "x_mm");
  given[Role::displacement].columns.emplace_back("y_mm");
  const Proposal proposal = propose(table, given, true);
  EXPECT_EQ(proposal.mapping.missing_in, (std::vector<ColumnCode>{{"x_mm", 0}}));
  ASSERT_EQ(proposal.warnings.size(), 1U);
  EXPECT_TRUE(proposal.warnings[0].starts_with("5 cells of 'x_mm' with 0, far from all other values"));
  document::Problems problems;
  const auto result = convert(table, proposal.mapping, problems);
  ASSERT_TRUE(result) << problems.format();
  const Log& log = result->log;
  ASSERT_EQ(log.size(), 200U);
  for (std::size_t i = 0; i < log.size(); ++i) {
    EXPECT_EQ(log.pressure_command_kpa[i], table.columns[1].values[i]) << i;
    EXPECT_EQ(std::isnan(log.displacement_mm[i]), i % 40 == 7) << i;
  }
  const Proposal again = propose(table, proposal.mapping, true);
  EXPECT_EQ(again.mapping, proposal.mapping) << "a stored mapping gives the same log";
  EXPECT_EQ(again.notes, std::vector<std::string>{"5 cells of 'x_mm' with 0 count as missing"});
}

TEST(Convert, CodesOfTheUserApplyToAllColumnsAndAreReported) {
  const ForeignTable table = table_of(with_dropouts());
  Mapping mapping = mapping_of("t_s", "p_cmd_kpa", "x_mm");
  mapping.missing = {"0"};
  document::Problems problems;
  const auto result = convert(table, propose(table, mapping, true).mapping, problems);
  ASSERT_TRUE(result) << problems.format();
  EXPECT_EQ(
      std::ranges::count(result->notes,
                         "--missing 0 applies to 1 cell of 't_s', 2 cells of 'p_cmd_kpa', 5 cells of 'x_mm'"),
      1)
      << with_commas(result->notes, [](const std::string& note) { return note; });
}

TEST(Convert, CodesForMissingValuesApplyToTheTime) {
  const std::string text = text_of("time_s,set_kpa,tip_mm", [](int i, double p, double y) {
    return i < 3 || i == 90 ? "-999," + shortest(p) + "," + shortest(y) : plain(i, p, y);
  });
  Mapping everywhere = mapping_of("time_s", "set_kpa", "tip_mm");
  everywhere.missing = {"-999"};
  Mapping in_time = mapping_of("time_s", "set_kpa", "tip_mm");
  in_time.missing_in = {{"time_s", -999}};
  for (const Mapping& mapping : {everywhere, in_time}) {
    const ImportedLog result = log_of(text, mapping);
    ASSERT_EQ(result.log.size(), 196U);
    EXPECT_NEAR(result.log.time_s.back(), 1.96, 1e-9);
    EXPECT_EQ(result.account.left_out[static_cast<std::size_t>(LeftOut::no_time)], 4U);
    EXPECT_TRUE(result.warnings.empty()) << result.warnings.front();
  }
}

TEST(Convert, CodesForMissingValuesApplyToEachOfTwoTimes) {
  const std::string text = text_of("t_set_s,set_kpa,t_tip_s,tip_mm", [](int i, double p, double y) {
    return shortest(0.01 * i) + "," + shortest(p) + "," +
           (i == 90 ? "-999" : shortest(0.01 * i + 0.003 + 0.0001 * (i % 7))) + "," + shortest(y);
  });
  Mapping mapping = mapping_of("t_set_s", "set_kpa", "tip_mm");
  mapping[Role::time].columns.emplace_back("t_tip_s");
  mapping.missing = {"-999"};
  const ImportedLog result = log_of(text, mapping);
  EXPECT_EQ(result.account.left_out[static_cast<std::size_t>(LeftOut::no_time)], 1U);
}

TEST(Convert, OverflowsOfTwoTimesAreNotes) {
  const std::string text = text_of("t_set_ms,set_kpa,t_tip_ms,tip_mm", [](int i, double p, double y) {
    return std::to_string(65'000 + 10 * i) + "," + shortest(p) + "," +
           std::to_string((65'003 + 10 * i) % 65'536) + "," + shortest(y);
  });
  Mapping mapping = mapping_of("t_set_ms", "set_kpa", "tip_mm");
  mapping[Role::time].columns.emplace_back("t_tip_ms");
  const ImportedLog result = log_of(text, mapping);
  EXPECT_EQ(
      std::ranges::count(result.notes,
                         "the clock overflows at 65536, 1 time, first in line 56 of 't_tip_ms', and the "
                         "times after each overflow are corrected"),
      1)
      << with_commas(result.notes, [](const std::string& note) { return note; });
}

TEST(Convert, LogContainsTheCorrectionsThatItsNotesState) {
  const ImportedLog result = log_of(text_of(
      "time_s,set_kpa,tip_mm", [](int i, double p, double y) { return plain(i, p, i == 0 ? 90 : y); }));
  ASSERT_FALSE(result.log.notes.empty());
  EXPECT_EQ(result.log.notes[0].text.find("the first reading was removed: the jump from 90 to "), 0U)
      << result.log.notes[0].text;
  EXPECT_TRUE(std::isnan(result.log.displacement_mm[0]));
  EXPECT_TRUE(std::isfinite(result.log.displacement_mm[1]));
}

TEST(Convert, AnOptionalColumnWithoutAValueInTheUsedRowsIsLeftOut) {
  const std::string text = text_of("time_s,set_kpa,tip_mm,temp_C", [](int i, double p, double y) {
    return plain(i, p, y) + "," + (i < 20 ? "21" : "");
  });
  Mapping mapping = mapping_of("time_s", "set_kpa", "tip_mm");
  mapping[Role::temperature].columns = {"temp_C"};
  mapping.from_s = 0.5;
  const ImportedLog result = log_of(text, mapping);
  EXPECT_TRUE(result.log.temperature_c.empty());
  EXPECT_EQ(
      std::ranges::count(result.notes,
                         "'temp_C' has no value in the rows that are used, so the log has no temperature"),
      1);
  const std::string empty =
      text_of("time_s,set_kpa,tip_mm,temp_C", [](int i, double p, double y) { return plain(i, p, y) + ","; });
  EXPECT_NE(refusal(empty, mapping).find("temperature: 'temp_C' has no value"), std::string::npos);
}

TEST(Convert, RateCountsSkippedLines) {
  const auto row = [](int i, double p, double y) {
    if (i >= 60 && i < 68) return shortest(p);
    return shortest(p) + (i == 90 ? ",lost" : "," + shortest(y));
  };
  document::Problems problems;
  TableOptions options;
  options.skip_bad_lines = true;
  const auto table = parse_text_table("t.csv", text_of("p_cmd_kpa,tip_mm", row), options, problems);
  ASSERT_TRUE(table) << problems.format();
  Mapping mapping = mapping_of("", "p_cmd_kpa", "tip_mm");
  mapping[Role::time].columns.clear();
  mapping.rate_hz = 100;
  mapping.skip_bad_lines = true;
  const auto result = convert(*table, mapping, problems);
  ASSERT_TRUE(result) << problems.format();
  const Log& log = result->log;
  ASSERT_EQ(log.size(), 191U);
  EXPECT_NEAR(log.time_s[59], 0.59, 1e-9);
  EXPECT_NEAR(log.time_s[60], 0.68, 1e-9) << "8 lines with too few cells were skipped";
  EXPECT_NEAR(log.time_s.back(), 1.99, 1e-9);
}

/// Returns the log of a text with a sampling rate of 100 Hz.
ImportedLog at_100_hz(const std::string& text) {
  Mapping mapping = mapping_of("", "p_cmd_kpa", "tip_mm");
  mapping[Role::time].columns.clear();
  mapping.rate_hz = 100;
  return log_of(text, mapping);
}

TEST(Convert, RateCountsEmptyLinesAndRowsInComments) {
  const ImportedLog result = at_100_hz(text_of("p_cmd_kpa,tip_mm",
                                               [](int i, double p, double y) {
                                                 const std::string row = shortest(p) + "," + shortest(y);
                                                 if (i == 30) return "# a remark\n" + row;
                                                 if (i >= 60 && i < 68) return "#" + row;
                                                 return i >= 100 && i < 103 ? "" : row;
                                               }) +
                                       "# 20,4\n\n\n");
  ASSERT_EQ(result.log.size(), 189U);
  EXPECT_NEAR(result.log.time_s[59], 0.59, 1e-9);
  EXPECT_NEAR(result.log.time_s[60], 0.68, 1e-9) << "8 rows are in comments";
  EXPECT_NEAR(result.log.time_s[92], 1.03, 1e-9) << "3 lines are empty";
  EXPECT_NEAR(result.log.time_s.back(), 1.99, 1e-9);
  EXPECT_EQ(result.account.sentence(), "200 rows: 189 used, 11 left out (3 without content, 8 in comments)");
}

TEST(Convert, RateCountsNoEmptyLineThatFollowsEveryRow) {
  const ImportedLog result = at_100_hz(text_of("p_cmd_kpa,tip_mm", [](int i, double p, double y) {
    const std::string row = shortest(p) + "," + shortest(y) + "\n";
    return i == 50 ? "#" + row : row;
  }));
  ASSERT_EQ(result.log.size(), 199U);
  EXPECT_NEAR(result.log.time_s.back(), 1.99, 1e-9);
  EXPECT_EQ(result.account.sentence(), "200 rows: 199 used, 1 left out (1 in comments)");
}

TEST(Convert, RowsInCommentsAreCountedWithATimeColumn) {
  const ImportedLog result = log_of(text_of("t_s,p_cmd_kpa,tip_mm", [](int i, double p, double y) {
    return (i == 70 ? "#" : "") + plain(i, p, y);
  }));
  EXPECT_EQ(result.account.sentence(), "200 rows: 199 used, 1 left out (1 in comments)");
}

TEST(Convert, RateCountsSkippedLinesOfTheSelectedFingerOnly) {
  const auto row = [](int i, double p, double y) {
    const std::string left = "left," + shortest(p), right = "right," + shortest(p);
    const std::string reading = "," + shortest(y);
    return left + (i == 40 ? "" : reading) + "\n" + right + (i < 20 ? "" : reading);
  };
  document::Problems problems;
  TableOptions options;
  options.skip_bad_lines = true;
  options.channel = "left";
  const auto table = parse_text_table("t.csv", text_of("channel,p_cmd_kpa,tip_mm", row), options, problems);
  ASSERT_TRUE(table) << problems.format();
  ASSERT_EQ(table->position.size(), 199U);
  EXPECT_EQ(table->position[39], 39U);
  EXPECT_EQ(table->position[40], 41U);
  EXPECT_EQ(table->position.back(), 199U);
}

/// Returns a text with the rows of two devices. The second device has 0.5 times the readings of the first.
std::string devices(const std::string& column, bool in_turn, double delay_s = 0) {
  std::array<std::string, 2> blocks;
  std::string mixed;
  for (int i = 0; i < 200; ++i) {
    const double p = 30 - std::abs(i % 100 - 50) * 0.6;
    for (int k = 0; k < 2; ++k) {
      const std::string row = shortest(0.01 * i + k * delay_s) + "," + std::to_string(k + 1) + "," +
                              shortest(p) + "," + shortest((1 - 0.5 * k) * (5 + 0.2 * p + 0.01 * i)) + "\n";
      mixed += row;
      blocks.at(static_cast<std::size_t>(k)) += row;
    }
  }
  return "t_s," + column + ",p_cmd_kpa,tip_mm\n" + (in_turn ? mixed : blocks[0] + blocks[1]);
}

TEST(Convert, RowsOfTwoDevicesAreReportedWithTheColumnThatSeparatesThem) {
  const Mapping mapping = mapping_of("t_s", "p_cmd_kpa", "tip_mm");
  const std::string expected = "the column 'id' (values 1, 2) separates them";
  for (const double delay_s : {0.0, 0.002}) {
    const ImportedLog mixed = log_of(devices("id", true, delay_s), mapping);
    const auto& warnings = mixed.warnings;
    EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [&](const std::string& w) {
      return w.find(expected) != std::string::npos;
    })) << delay_s;
    EXPECT_TRUE(std::none_of(warnings.begin(), warnings.end(),
                             [](const std::string& w) { return w.find("--rate-hz") != std::string::npos; }));
  }
  const std::string refused = refusal(devices("id", false), mapping);
  EXPECT_NE(refused.find("the time goes back"), std::string::npos) << refused;
  EXPECT_NE(refused.find(expected), std::string::npos) << refused;
  EXPECT_EQ(refused.find("--rate-hz"), std::string::npos) << refused;
}

TEST(Convert, ARowCounterOfATimeStampIsNoDevice) {
  const ImportedLog log = log_of(text_of("t_s,sample,p_cmd_kpa,tip_mm", [](int i, double p, double y) {
    return shortest(0.02 * (i / 2)) + "," + std::to_string(i % 2) + "," + shortest(p) + "," + shortest(y);
  }));
  ASSERT_FALSE(log.warnings.empty());
  EXPECT_NE(log.warnings.back().find("--rate-hz 100 instead of --time"), std::string::npos)
      << log.warnings.back();
}

/// Line 22 has more cells than the header. Line 40 has a cell that is not a number.
TEST(Convert, OmittedLinesAreCountedWithTwoTimeColumns) {
  const std::string text = text_of("t_set_s,set_kpa,t_tip_s,tip_mm", [](int i, double p, double y) {
    if (i == 20) return std::string("0.2,3,0.2,4,5");
    const std::string tip = i == 38 ? "broken" : shortest(y);
    return shortest(0.01 * i) + "," + shortest(p) + "," + shortest(0.01 * i + 0.003 + 0.0001 * (i % 7)) +
           "," + tip;
  });
  Mapping mapping;
  mapping[Role::time].columns = {"t_set_s", "t_tip_s"};
  mapping[Role::command].columns = {"set_kpa"};
  mapping[Role::displacement].columns = {"tip_mm"};
  mapping.skip_bad_lines = true;
  document::Problems problems;
  TableOptions options;
  options.skip_bad_lines = true;
  const auto table = parse_text_table("t.csv", text, options, problems);
  ASSERT_TRUE(table) << problems.format();
  const auto result = convert(*table, propose(*table, mapping, true).mapping, problems);
  ASSERT_TRUE(result) << problems.format();
  EXPECT_TRUE(result->account.balanced());
  // Each row of the table has two times, so an omitted row counts twice. The line with the wrong number of
  // cells counts once.
  EXPECT_EQ(result->account.left_out[static_cast<std::size_t>(LeftOut::bad_line)], 3U);
}

/// Returns the note about a clock overflow that the import prints. @param broken  index of a row that gets a
/// cell that is not a number, or -1.
std::string note_of_overflow(int broken) {
  const std::string text = text_of("t_ms,set_kpa,tip_mm", [broken](int i, double p, double y) {
    return std::to_string((i * 10 + 65000) % 65536) + "," + shortest(p) + "," +
           (i == broken ? "x" : shortest(y));
  });
  Mapping mapping = mapping_of("t_ms", "set_kpa", "tip_mm");
  mapping.skip_bad_lines = broken >= 0;
  document::Problems problems;
  TableOptions options;
  options.skip_bad_lines = broken >= 0;
  const auto table = parse_text_table("t.csv", text, options, problems);
  EXPECT_TRUE(table) << problems.format();
  const auto result = convert(*table, propose(*table, mapping, true).mapping, problems);
  EXPECT_TRUE(result) << problems.format();
  for (const std::string& note : result ? result->notes : std::vector<std::string>{}) {
    if (note.find("overflows") != std::string::npos) return note;
  }
  return {};
}

TEST(Convert, OverflowNoteStatesTheLineOfTheFile) {
  EXPECT_NE(note_of_overflow(-1).find("line 56"), std::string::npos) << note_of_overflow(-1);
  EXPECT_EQ(note_of_overflow(10), note_of_overflow(-1))
      << "a skipped row before the overflow must not change the line number";
}

}  // namespace
}  // namespace softgrip::sysid::conversion_test
