// Runs softgrip identify and softgrip validate as a user runs them. Checks exit codes and files. Also checks
// that a refused command writes no file.

#include <algorithm>
#include <filesystem>
#include <utility>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/stress_softening.h"
#include "model/file/model_file.h"
#include "model/named.h"
#include "tests/sysid/command_fixture.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::command_test {
namespace {

namespace fs = std::filesystem;

class Command : public CommandInFolder {
 protected:
  void write_log(const std::string& name, model::SignalName signal) {
    write(name, format_log(simulated(loaded("zhang2025"), signal, 20, 0.05, 7)));
  }
};

TEST_F(Command, IdentifyWritesModelJsonAndReport) {
  write_log("tp1.csv", model::SignalName::tp1);
  write_log("sp1.csv", model::SignalName::sp1);
  ASSERT_EQ(run("identify --data tp1.csv --validate sp1.csv --out result --json"), 0) << read("err.txt");
  const auto json = nlohmann::json::parse(read("result/identify.json"));
  EXPECT_EQ(json["schema"], 1);
  EXPECT_NEAR(json["rmse_mm"]["tp1"], 0.05, 0.005);
  EXPECT_GT(json["rmse_percent_of_span"]["tp1"], 0);
  EXPECT_NEAR(json["validation"]["rmse_mm"]["sp1"], 0.05, 0.005);
  for (const char* key : {"value", "ci95", "identifiable"}) {
    EXPECT_TRUE(json["parameters"]["bouc_wen.beta_mm_per_kpa"].contains(key)) << key;
    EXPECT_TRUE(json["combinations"]["instantaneous_gain_mm_per_kpa"].contains(key)) << key;
  }
  EXPECT_EQ(json["multistart"]["starts"], 20);
  EXPECT_TRUE(json.contains("wall_s"));
  EXPECT_EQ(read("out.txt"), read("result/identify.json"));
  document::Problems problems;
  EXPECT_TRUE(model::load_model((folder_ / "result/model.yaml").string(), problems)) << problems.format();
  const std::string html = read("result/report.html");
  EXPECT_LT(html.size(), 1'500'000U);
  EXPECT_EQ(html.find("<script"), std::string::npos);
  ASSERT_EQ(run("validate --model result/model.yaml --data sp1.csv --out checked"), 0) << read("err.txt");
  EXPECT_TRUE(fs::exists(folder_ / "checked/validate.json"));
  EXPECT_EQ(run("validate --model result/model.yaml --data sp1.csv --at-most-percent 0.01"), 6);
}

TEST_F(Command, IdentifyAcceptsDeprecatedNamesAndWritesThemInJsonOnly) {
  write_log("tp1.csv", model::SignalName::tp1);
  const model::BlockSpec softening =
      model::block_of<model::StressSoftening>({{"softening_per_kpa", 0.001}, {"saturation_per_kpa", 0.03}});
  write("model.yaml", model::to_yaml(model::with_block(loaded("zhang2025"), softening)));
  for (const std::string name : {"saturation_per_kpa", "levelling_per_kpa"}) {
    ASSERT_EQ(
        run("identify --starts 1 --start model.yaml --data tp1.csv --out result --fix stress_softening." +
            name),
        0)
        << read("err.txt");
    const auto json = nlohmann::json::parse(read("result/identify.json"));
    const auto& fixed = json["parameters"]["stress_softening.saturation_per_kpa"];
    EXPECT_EQ(fixed["free"], false) << name;
    EXPECT_EQ(fixed["value"], 0.03) << name;
    EXPECT_EQ(json["parameters"]["stress_softening.levelling_per_kpa"], fixed);
    EXPECT_EQ(json["parameters"]["stress_softening.softening_per_kpa"]["free"], true);
    const auto& combinations = json["combinations"];
    for (const auto& [now, before] :
         {std::pair{"saturation_growing_per_kpa", "levelling_growing_per_kpa"},
          std::pair{"saturation_shrinking_per_kpa", "levelling_shrinking_per_kpa"}}) {
      EXPECT_TRUE(combinations[now]["value"].is_number()) << now;
      EXPECT_EQ(combinations[before], combinations[now]);
    }
    for (const char* const file : {"out.txt", "result/model.yaml"})
      EXPECT_EQ(read(file).find("levelling"), std::string::npos) << file;
    EXPECT_NE(read("out.txt").find("saturation_growing_per_kpa"), std::string::npos) << read("out.txt");
  }
  EXPECT_EQ(run("identify --starts 1 --start model.yaml --data tp1.csv --out free --free "
                "stress_softening.levelling_per_kpa"),
            0);
  const auto json = nlohmann::json::parse(read("free/identify.json"));
  EXPECT_EQ(json["parameters"]["stress_softening.saturation_per_kpa"]["free"], true);
  EXPECT_EQ(json["parameters"]["stress_softening.softening_per_kpa"]["free"], false);
}

TEST_F(Command, EveryScoreStatesTheDriveOfTheModel) {
  Log log = simulated(loaded("zhang2025"), model::SignalName::tp1, 20, 0.05, 7);
  log.pressure_kpa = log.pressure_command_kpa;
  write("tp1.csv", format_log(log));
  write("sp1.csv", format_log(log));
  write("model.yaml", model::to_yaml(loaded("zhang2025")));
  for (const auto& [option, drive] :
       {std::pair{"command", "command"}, std::pair{"measured", "measured pressure"}}) {
    const std::string begin =
        std::string("identify --starts 1 --start model.yaml --fit-share 0.8 --drive ") + option;
    ASSERT_EQ(run(begin + " --data tp1.csv --validate sp1.csv --out result"), 0) << read("err.txt");
    const auto json = nlohmann::json::parse(read("result/identify.json"));
    EXPECT_EQ(json["drive"]["tp1"], drive);
    EXPECT_EQ(json["held_out"]["drive"]["tp1"], drive);
    EXPECT_EQ(json["validation"]["drive"]["sp1"], drive);
    EXPECT_NE(read("out.txt").find(std::string("driven by the ") + drive), std::string::npos)
        << read("out.txt");
    ASSERT_EQ(run(std::string("validate --model model.yaml --data sp1.csv --json --drive ") + option), 0);
    EXPECT_EQ(nlohmann::json::parse(read("out.txt"))["drive"]["sp1"], drive);
  }
}

/// If a log is cut between two cycles, where the pressure is 0, it seems to begin at rest although the finger
/// is not at rest.
TEST_F(Command, BeginOptionSelectsTheEstimatedInitialState) {
  const Log log = simulated(loaded("bench_twin"), model::SignalName::tp1, 50, 0.05, 7);
  std::size_t first = log.size() / 4;
  while (log.pressure_command_kpa[first] > 0) ++first;
  write("cut.csv", format_log(slice(log, first, log.size())));
  write("model.yaml", model::to_yaml(loaded("bench_twin")));
  const auto percent = [&](const std::string& begin) {
    EXPECT_EQ(run("validate --model model.yaml --data cut.csv --json --begin " + begin), 0)
        << read("err.txt");
    return nlohmann::json::parse(read("out.txt"))["rmse_percent_of_span"]["cut"].get<double>();
  };
  EXPECT_GT(percent("rest"), 3);
  EXPECT_LT(percent("unknown"), 2);
  EXPECT_LT(percent("auto"), 2);
}

TEST_F(Command, ValidateReportsEachLogAboveThePermittedError) {
  write_log("tp1.csv", model::SignalName::tp1);
  write_log("hold.csv", model::SignalName::hold);
  write("model.yaml", model::to_yaml(loaded("zhang2025")));
  ASSERT_EQ(run("validate --model model.yaml --data tp1.csv hold.csv --out fine"), 0) << read("err.txt");
  EXPECT_FALSE(nlohmann::json::parse(read("fine/validate.json")).contains("acceptable"));
  const auto percent = nlohmann::json::parse(read("fine/validate.json"))["rmse_percent_of_span"];
  const double between = 0.5 * (percent["tp1"].get<double>() + percent["hold"].get<double>());
  const std::string bound = "validate --model model.yaml --data tp1.csv hold.csv --at-most-percent " +
                            std::to_string(between) + " --out out";
  ASSERT_EQ(run(bound), 6) << read("err.txt");
  const auto json = nlohmann::json::parse(read("out/validate.json"));
  EXPECT_EQ(json["acceptable"]["tp1"], percent["tp1"].get<double>() <= between);
  EXPECT_NE(json["acceptable"]["tp1"], json["acceptable"]["hold"]);
  EXPECT_NE(read("out.txt").find("1 of these logs with an error above the permitted"), std::string::npos)
      << read("out.txt");
  EXPECT_NE(read("out.txt").find("FAILED: above"), std::string::npos) << read("out.txt");
  for (const char* text : {"out.txt", "out/validate.json", "out/report.html"})
    EXPECT_EQ(read(text).find("nan"), std::string::npos)
        << text
        << ": a log that only holds a pressure has no settled cycles, and this must not be printed as nan";
}

TEST_F(Command, WarnsOfImplausibleUnitsSignsAndColumns) {
  write("model.yaml", model::to_yaml(loaded("zhang2025")));
  const auto warned = [&](auto change) {
    Log log = simulated(loaded("zhang2025"), model::SignalName::tp1, 20, 0.05, 7);
    change(log);
    write("odd.csv", format_log(log));
    EXPECT_EQ(run("validate --model model.yaml --data odd.csv --out odd"), 0) << read("err.txt");
    const std::string warnings = nlohmann::json::parse(read("odd/validate.json"))["warnings"].dump();
    EXPECT_EQ(warnings == "[]", read("out.txt").find("warning: ") == std::string::npos);
    return warnings;
  };
  const auto scaled = [](std::vector<double>& values, double by) {
    for (double& value : values) value *= by;
  };
  EXPECT_EQ(warned([](Log&) {}), "[]");
  EXPECT_NE(warned([&](Log& l) { scaled(l.displacement_mm, -1); }).find("the reading decreases"),
            std::string::npos);
  EXPECT_NE(warned([](Log& l) { std::swap(l.displacement_mm, l.pressure_command_kpa); }).find("swapped"),
            std::string::npos);
  for (const auto& [factor, unit] : {std::pair{6.894757, "psi"}, {100.0, "bar"}})
    EXPECT_NE(warned([&, by = 1 / factor](Log& l) { scaled(l.pressure_command_kpa, by); }).find(unit),
              std::string::npos);
  for (const auto& [factor, unit] :
       {std::pair{0.1, "cm"}, {1 / 25.4, "inch"}, {1e-3, "metres"}, {100.0, "bar"}})
    EXPECT_NE(warned([&, by = factor](Log& l) { scaled(l.displacement_mm, by); }).find(unit),
              std::string::npos);
}

/// Returns the rise of the command to its highest pressure as a separate log.
Log loading() {
  const Log whole = simulated(loaded("zhang2025"), model::SignalName::tp1, 20, 0.05, 7);
  const std::vector<double>& kpa = whole.pressure_command_kpa;
  const auto end = static_cast<std::size_t>(std::max_element(kpa.begin(), kpa.end()) - kpa.begin());
  std::size_t begin = end;
  while (begin > 0 && kpa[begin - 1] < kpa[begin]) --begin;
  return slice(whole, begin, end);
}

/// Returns the lines of an output that precede its first empty line.
std::string first_lines(const std::string& text) {
  return text.substr(0, text.find("\n\n"));
}

TEST_F(Command, IdentifyStatesMissingExcitationFirst) {
  write("loading.csv", format_log(loading()));
  ASSERT_EQ(run("identify --starts 2 --data loading.csv --out result"), 0) << read("err.txt");
  const std::string lines = first_lines(read("out.txt"));
  EXPECT_NE(lines.find("the logs contain no unloading"), std::string::npos) << lines;
  EXPECT_NE(lines.find("require the missing excitation: bouc_wen.beta_mm_per_kpa"), std::string::npos)
      << lines;
  EXPECT_NE(nlohmann::json::parse(read("result/identify.json"))["warnings"].dump().find("unloading"),
            std::string::npos);
}

TEST_F(Command, OutliersAreNamedFirstAndNotFitted) {
  Log log = simulated(loaded("zhang2025"), model::SignalName::tp1, 20, 0.05, 7);
  for (std::size_t i = 0; i < log.size(); i += log.size() / 6) log.displacement_mm[i] = -999;
  write("codes.csv", format_log(log));
  ASSERT_EQ(run("identify --starts 5 --data codes.csv --validate codes.csv --out result"), 0)
      << read("err.txt");
  const std::string lines = first_lines(read("out.txt"));
  EXPECT_NE(lines.find("readings are outliers, removed: -999 mm at 0 s"), std::string::npos) << lines;
  const auto json = nlohmann::json::parse(read("result/identify.json"));
  EXPECT_NEAR(json["rmse_mm"]["codes"].get<double>(), 0.05, 0.005);
  EXPECT_NEAR(json["validation"]["rmse_mm"]["codes"].get<double>(), 0.05, 0.005);
  ASSERT_EQ(run("validate --model result/model.yaml --data codes.csv --json"), 0) << read("err.txt");
  const auto validated = nlohmann::json::parse(read("out.txt"));
  EXPECT_NEAR(validated["rmse_mm"]["codes"].get<double>(), 0.05, 0.005);
  EXPECT_NE(validated["warnings"].dump().find("are outliers, removed"), std::string::npos);
}

/// The creep of this model continues almost without limit. A long log shows this property, but a short log
/// does not.
TEST_F(Command, APredictionThatDivergesIsNotAcceptable) {
  write_log("tp1.csv", model::SignalName::tp1);
  write("loading.csv", format_log(loading()));
  model::Model creeping = loaded("zhang2025");
  std::vector<double>& values = creeping.blocks[*model::position_of<model::KelvinVoigt>(creeping)].values;
  values[1] = 1e-6;
  values[2] = 3;
  write("creeping.yaml", model::to_yaml(creeping));
  EXPECT_EQ(run("validate --model creeping.yaml --data tp1.csv --out checked"), 6) << read("out.txt");
  EXPECT_NE(read("out.txt").find("the prediction of tp1 diverges"), std::string::npos) << read("out.txt");
  EXPECT_NE(read("out.txt").find("FAILED: the prediction diverges"), std::string::npos) << read("out.txt");
  const std::string identify =
      "identify --start creeping.yaml --free bouc_wen.alpha_mm_per_kpa --starts 1 --data loading.csv --out ";
  EXPECT_EQ(run(identify + "fitted"), 0) << read("out.txt");
  EXPECT_EQ(run(identify + "predicted --validate tp1.csv"), 6) << read("out.txt");
  EXPECT_NE(first_lines(read("out.txt")).find("the prediction of tp1 diverges"), std::string::npos)
      << read("out.txt");
}

/// The reading 9999 is wrong, because it exceeds any displacement in mm. The unit of the column is correct.
TEST_F(Command, ErrorCode9999IsNotTreatedAsAUnitError) {
  Log log = simulated(loaded("zhang2025"), model::SignalName::tp1, 20, 0.05, 7);
  log.displacement_mm[30] = log.displacement_mm[50] = 9999;
  write("codes.csv", format_log(log));
  EXPECT_EQ(run("identify --data codes.csv --out result"), 3);
  EXPECT_NE(read("err.txt").find("a code for a missing reading"), std::string::npos) << read("err.txt");
  EXPECT_EQ(read("err.txt").find("micrometres"), std::string::npos) << read("err.txt");
  EXPECT_NE(read("err.txt").find("--missing-in displacement_mm=9999"), std::string::npos) << read("err.txt");
}

/// With a factor of 1e-3, the pressures are in MPa, and the log is accepted. With a factor of 1e-6, the log
/// is refused. In both cases, a message names the units that the values may have.
TEST_F(Command, WrongPressureUnitIsNamedEvenIfTheLogIsRefused) {
  const auto identified = [&](double factor, const char* out) {
    Log log = simulated(loaded("zhang2025"), model::SignalName::tp1, 20, 0.05, 7);
    for (double& kpa : log.pressure_command_kpa) kpa *= factor;
    write("other_unit.csv", format_log(log));
    const int code = run(std::string("identify --data other_unit.csv --out ") + out);
    for (const char* part : {"check if the values are in MPa, bar or V instead of kPa. The largest value of "
                             "`pressure_command_kpa` is ",
                             "State the unit of this column: `softgrip import --unit command=MPa`"})
      EXPECT_NE((read("out.txt") + read("err.txt")).find(part), std::string::npos) << factor << part;
    return code;
  };
  EXPECT_EQ(identified(1e-3, "muscle"), 0);
  EXPECT_EQ(identified(1e-6, "result"), 3);
  EXPECT_FALSE(fs::exists(folder_ / "result"));
}

TEST_F(Command, TheSameInputsGiveTheSameReport) {
  write_log("tp1.csv", model::SignalName::tp1);
  ASSERT_EQ(run("identify --data tp1.csv --out a"), 0);
  ASSERT_EQ(run("identify --data tp1.csv --out b"), 0);
  EXPECT_EQ(read("a/report.html"), read("b/report.html"));
  EXPECT_EQ(read("a/model.yaml"), read("b/model.yaml"));
}

TEST_F(Command, ABadLogIsRefusedAndNothingWritten) {
  write_log("good.csv", model::SignalName::tp1);
  write("bad.csv", "time_s,pressure_command_bar,displacement_mm\n0,1,2\n");
  EXPECT_EQ(run("identify --data good.csv bad.csv --out result"), 3);
  EXPECT_FALSE(fs::exists(folder_ / "result"));
  EXPECT_NE(read("err.txt").find("bad.csv:1:8: column 'pressure_command_bar' has the wrong unit"),
            std::string::npos)
      << read("err.txt");
  EXPECT_EQ(run("identify --data good.csv --validate bad.csv --out result"), 3);
  EXPECT_FALSE(fs::exists(folder_ / "result"));
}

TEST_F(Command, UnusableOutputFolderIsReportedBeforeTheComputation) {
  write_log("tp1.csv", model::SignalName::tp1);
  write("model.yaml", model::to_yaml(loaded("zhang2025")));
  write("notes.txt", "other data\n");
  const std::string data = " --data tp1.csv --out ";
  for (const std::string command :
       {"identify", "validate --model model.yaml", "diagnose --model model.yaml",
        "diagnose --model model.yaml --healthy tp1.csv", "baseline --model model.yaml"}) {
    EXPECT_EQ(run(command + data + "tp1.csv"), 2) << command;
    EXPECT_NE(read("err.txt").find("tp1.csv is an input of this command"), std::string::npos)
        << read("err.txt");
    EXPECT_EQ(run(command + data + "notes.txt/sub"), 4) << command;
    EXPECT_EQ(run(command + data + "notes.txt"), 4) << command;
    EXPECT_EQ(read("err.txt"),
              "softgrip: cannot write into notes.txt: it is a file, not a folder. Name another folder\n");
    EXPECT_EQ(read("out.txt"), "");
  }
}

TEST_F(Command, ResultOfAnotherCommandIsNotReplaced) {
  write_log("tp1.csv", model::SignalName::tp1);
  ASSERT_EQ(run("identify --starts 1 --data tp1.csv --out id"), 0) << read("err.txt");
  const std::string page = read("id/report.html");
  EXPECT_EQ(run("validate --model id/model.yaml --data tp1.csv --out id"), 5);
  EXPECT_NE(read("err.txt").find("id/identify.json already exists"), std::string::npos) << read("err.txt");
  EXPECT_EQ(read("id/report.html"), page);
  EXPECT_FALSE(fs::exists(folder_ / "id/validate.json"));
  EXPECT_EQ(run("identify --starts 1 --data tp1.csv --out id"), 0) << "a command may replace its own result";
}

TEST_F(Command, FolderInsteadOfAFileIsRefusedWithTheFileInIt) {
  write_log("tp1.csv", model::SignalName::tp1);
  write("id/model.yaml", model::to_yaml(loaded("zhang2025")));
  EXPECT_EQ(run("validate --model id --data tp1.csv"), 4);
  EXPECT_EQ(read("err.txt"),
            "softgrip: cannot read id: it is a folder, and this option requires a file. Give the file "
            "id/model.yaml instead\n");
  for (const std::string command :
       {"validate --model id/model.yaml --data id", "import id --yes --out x.csv", "plot id --out x.svg"}) {
    EXPECT_EQ(run(command), 4) << command;
    EXPECT_NE(read("err.txt").find("id is not a recording, because this folder contains no run.csv"),
              std::string::npos)
        << read("err.txt");
  }
}

TEST_F(Command, OptionInPlaceOfAValueIsReported) {
  EXPECT_EQ(run("diagnose --model model.yaml --data tp1.csv --healthy --out d"), 2);
  EXPECT_NE(read("err.txt").find("--healthy: the value is missing, because --out is the name of an option"),
            std::string::npos)
      << read("err.txt");
  EXPECT_EQ(run("identify --data --out d"), 2);
  EXPECT_NE(read("err.txt").find("--data: the value is missing"), std::string::npos) << read("err.txt");
}

TEST_F(Command, RefusedInputsGiveTheMatchingExitCode) {
  write_log("tp1.csv", model::SignalName::tp1);
  EXPECT_EQ(run("identify --data absent.csv --out result"), 4);
  EXPECT_EQ(run("identify --data tp1.csv --start absent.yaml --out result"), 4);
  EXPECT_EQ(run("identify --data tp1.csv"), 2);
  EXPECT_EQ(run("identify --data tp1.csv --fix bouc_wen.delta --out result"), 3);
  EXPECT_EQ(run("identify --data tp1.csv --drive measured --out result"), 3);
  EXPECT_EQ(run("identify --data tp1.csv --out /proc/nowhere"), 4);
  EXPECT_FALSE(fs::exists(folder_ / "result"));
}

}  // namespace
}  // namespace softgrip::sysid::command_test
