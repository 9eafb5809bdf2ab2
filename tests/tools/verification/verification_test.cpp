// Tests softgrip report --verify with the result files of softgrip identify.

#include "tools/verification/verification.h"

#include <algorithm>
#include <filesystem>
#include <tuple>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "model/file/model_file.h"
#include "tests/sysid/command_fixture.h"

namespace softgrip::tools::verification_test {
namespace {

class Verification : public sysid::CommandInFolder {
 protected:
  void SetUp() override {
    CommandInFolder::SetUp();
    const std::string models = SOFTGRIP_SOURCE_DIR "/config/models/";
    for (const auto& [signal, log] : {std::pair{"tp1", "fit.csv"}, {"sp1", "other.csv"}})
      ASSERT_EQ(
          run("simulate --model " + models +
              "bench_twin.yaml --noise-mm 0.05 --seed 3 --rate-hz 20 --input " + signal + " --out " + log),
          0);
    ASSERT_EQ(run("identify --start " + models +
                  "zhang2025.yaml --starts 3 --data fit.csv --validate other.csv --out report"),
              0)
        << read("err.txt");
  }
  void replace(const std::string& file, const std::string& was, const std::string& is) {
    std::string text = read(file);
    const std::size_t at = text.find(was);
    ASSERT_NE(at, std::string::npos) << file << " has no " << was;
    write(file, text.replace(at, was.size(), is));
  }
  [[nodiscard]] nlohmann::json verified(int code) {
    EXPECT_EQ(run("report --verify report --json"), code) << read("err.txt");
    return nlohmann::json::parse(read("out.txt"));
  }
};

TEST_F(Verification, ReproducesAnUnchangedReport) {
  const auto json = verified(0);
  EXPECT_EQ(json["same"], true);
  EXPECT_GT(json["numbers"], 5000) << "the comparison must include the numbers of all series";
  EXPECT_EQ(
      run("validate --model report/model.yaml --data other.csv --at-most-percent 50 --held --out judged"), 0);
  EXPECT_EQ(run("report --verify judged/"), 0) << read("err.txt");
}

TEST_F(Verification, NamesEveryChangedNumber) {
  const double rmse_mm =
      nlohmann::json::parse(read("report/identify.json"))["validation"]["rmse_mm"]["other"];
  auto report = nlohmann::ordered_json::parse(read("report/identify.json"));
  report["validation"]["rmse_mm"]["other"] = rmse_mm / 2;
  write("report/identify.json", report.dump());
  replace("report/model.yaml", "alpha_mm_per_kpa: 0.", "alpha_mm_per_kpa: 0.1");
  const auto json = verified(6);
  ASSERT_EQ(json["differences"].size(), 2U) << json.dump(1);
  EXPECT_EQ(json["differences"][0]["where"], "identify.json: validation.rmse_mm.other");
  EXPECT_NEAR(std::stod(json["differences"][0]["recomputed"].get<std::string>()), rmse_mm, 1e-9);
  EXPECT_EQ(json["differences"][1]["where"], "model.yaml: bouc_wen.alpha_mm_per_kpa");
}

TEST_F(Verification, RefusesAMissingOrModifiedLogWithTheHash) {
  const std::string sha = nlohmann::json::parse(read("report/identify.json"))["logs"][0]["sha256"];
  std::filesystem::create_directory(folder_ / "elsewhere");
  std::filesystem::rename(folder_ / "fit.csv", folder_ / "elsewhere/fit.csv");
  EXPECT_NE(verified(3)["missing"][0].get<std::string>().find("log fit.csv, sha256 " + sha + ": not found"),
            std::string::npos);
  write("fit.csv", read("elsewhere/fit.csv") + "\n");
  EXPECT_NE(verified(3)["missing"][0].get<std::string>().find("differs from the file that the report used"),
            std::string::npos);
  std::filesystem::rename(folder_ / "elsewhere/fit.csv", folder_ / "report/fit.csv");
  EXPECT_EQ(verified(0)["same"], true)
      << "the log is found next to the report, regardless of the file at its old path";
}

TEST_F(Verification, RefusesAReportWithoutTheCommandThatWroteTheReport) {
  replace("report/identify.json", "\"call\"", "\"called\"");
  EXPECT_NE(
      verified(3)["missing"][0].get<std::string>().find("does not contain the command that wrote this file"),
      std::string::npos);
  EXPECT_EQ(run("report --verify nowhere"), 3);
  EXPECT_EQ(run("report"), 2);
}

TEST_F(Verification, RefusesACommandThatWritesToAnotherFolder) {
  replace("report/identify.json", "\"--starts\"", "\"--out=/tmp\"");
  EXPECT_NE(verified(3)["missing"][0].get<std::string>().find("key `call`"), std::string::npos);
}

/// Another program or an attacker may have written a report. For every malformed report, the command must
/// print an error message and return exit code 3.
TEST_F(Verification, AMalformedReportIsRefusedWithASentence) {
  const std::string good = read("report/identify.json");
  const auto spoilt = [&](const char* pointer, const nlohmann::ordered_json& value) {
    auto json = nlohmann::ordered_json::parse(good);
    json[nlohmann::ordered_json::json_pointer(pointer)] = value;
    return json.dump();
  };
  const std::string long_name(5000, 'x');
  const std::string brackets = std::string(300'000, '[') + std::string(300'000, ']');
  for (const std::string& text : {std::string(),
                                  std::string("[]"),
                                  std::string("3"),
                                  std::string("{\"call\":["),
                                  brackets,
                                  "{\"call\":" + brackets + "}",
                                  spoilt("/call", 3),
                                  spoilt("/call", {{"identify", 1}}),
                                  spoilt("/call", {"identify", 3}),
                                  spoilt("/call", {"identify", nullptr}),
                                  spoilt("/logs", 3),
                                  spoilt("/logs", {{"path", "fit.csv"}}),
                                  spoilt("/logs/0", "fit.csv"),
                                  spoilt("/logs/0/sha256", 3),
                                  spoilt("/logs/0/path", {1}),
                                  spoilt("/call", {"identify", "--data", long_name}),
                                  spoilt("/call", {"identify", "--data", "."}),
                                  spoilt("/call", {"identify", "--data", ""}),
                                  spoilt("/call", {"identify", "--start", "report"}),
                                  spoilt("/call", {"validate", "--data", "fit.csv"}),
                                  spoilt("/start", 3),
                                  spoilt("/start/hash", {1}),
                                  spoilt("/call", {"identify", "--nonsense"})}) {
    write("report/identify.json", text);
    EXPECT_EQ(run("report --verify report"), 3) << text.substr(0, 200);
    const std::string said = read("err.txt");
    EXPECT_NE(said.find("softgrip: "), std::string::npos) << said;
    EXPECT_EQ(said.find("exception"), std::string::npos) << said;
    EXPECT_EQ(said.find("filesystem error"), std::string::npos) << said;
    run("report --verify report --json");
    EXPECT_TRUE(nlohmann::json::accept(read("out.txt"))) << read("out.txt").substr(0, 200);
  }
  // The value of "software" has a wrong type. The verification does not use this value, so it must succeed.
  write("report/identify.json", spoilt("/software", {1}));
  EXPECT_EQ(verified(0)["reported_by"], "");
}

bool has_control_characters(const std::string& text) {
  return std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 && c != '\n'; });
}

TEST_F(Verification, ControlCharactersOfAReportAreNotPrinted) {
  const auto spoilt = [&](const char* key, const nlohmann::json& value) {
    auto report = nlohmann::ordered_json::parse(read("report/identify.json"));
    report[nlohmann::ordered_json::json_pointer(key)] = value;
    return report.dump();
  };
  const std::string rest = "\x1b[2J\x07";
  for (const auto& [key, value, code] :
       {std::tuple<const char*, nlohmann::json, int>{"/software", "softgrip" + rest, 0},
        {"/call", {"identify", "--data", "a" + rest}, 3},
        {"/call/-", "--non" + rest, 3},
        {"/logs/0/sha256", rest, 3}}) {
    const std::string unchanged = read("report/identify.json");
    write("report/identify.json", spoilt(key, value));
    EXPECT_EQ(run("report --verify report"), code) << key;
    write("report/identify.json", unchanged);
    const std::string said = read("out.txt") + read("err.txt");
    EXPECT_NE(said.find("\\x1b[2J\\x07"), std::string::npos) << key << ": " << said;
    EXPECT_FALSE(has_control_characters(said)) << key << ": " << said;
  }
}

TEST_F(Verification, ControlCharactersInTheNameOfALogAreNotPrinted) {
  const std::string model = SOFTGRIP_SOURCE_DIR "/config/models/bench_twin.yaml";
  std::filesystem::rename(folder_ / "other.csv", folder_ / "a\x1b[2J.csv");
  for (const char* command : {"validate --model ", "validate --at-most-percent 0 --model "}) {
    run(command + model + " --data a*.csv");
    EXPECT_NE(read("out.txt").find("a\\x1b[2J"), std::string::npos) << read("out.txt") << read("err.txt");
    EXPECT_FALSE(has_control_characters(read("out.txt") + read("err.txt")));
  }
  EXPECT_EQ(run("simulate --model " + model + " --input a*.csv --out b.csv"), 0) << read("err.txt");
  EXPECT_NE(read("out.txt").find("a\\x1b[2J.csv"), std::string::npos) << read("out.txt");
  EXPECT_FALSE(has_control_characters(read("out.txt") + read("err.txt")));
}

using Json = nlohmann::ordered_json;

std::vector<std::string> places(const Comparison& comparison) {
  std::vector<std::string> all;
  for (const Difference& difference : comparison.differences) all.push_back(difference.where);
  return all;
}

TEST(Comparison, NamesEveryNumberOfAJsonThatDiffers) {
  const Json was{
      {"rmse_mm", {{"a", 0.1}, {"b", 0.2}}}, {"list", {1, 2, 3}}, {"verdict", "x"}, {"n", nullptr}};
  Json is = was;
  Comparison same{1e-6, 0, {}};
  compare_json("f.json", was, is, same);
  EXPECT_TRUE(same.differences.empty());
  EXPECT_EQ(same.numbers, 5U);
  is["rmse_mm"]["b"] = 0.2001;
  is["list"][2] = 4;
  is["verdict"] = "y";
  is["n"] = 1;
  is["more"] = true;
  Comparison other{1e-6, 0, {}};
  compare_json("f.json", was, is, other);
  EXPECT_EQ(places(other), (std::vector<std::string>{"f.json: list[2]", "f.json: more", "f.json: n",
                                                     "f.json: rmse_mm.b", "f.json: verdict"}));
  EXPECT_EQ(other.differences[3].reported, "0.2");
  EXPECT_EQ(other.differences[3].recomputed, "0.2001");
}

TEST(Comparison, ANewNameOfAReportedKeyIsNoDifference) {
  const Json was{{"gain_percent", {{"value", 3.0}}}};
  const Json same{{"error_reduction_percent", {{"value", 3.0}}}, {"gain_percent", {{"value", 3.0}}}};
  const Json changed{{"error_reduction_percent", {{"value", 4.0}}}, {"gain_percent", {{"value", 4.0}}}};
  const Json unequal{{"error_reduction_percent", {{"value", 4.0}}}, {"gain_percent", {{"value", 3.0}}}};
  Comparison none{1e-6, 0, {}}, value{1e-6, 0, {}}, key{1e-6, 0, {}};
  compare_json("f.json", was, same, none);
  compare_json("f.json", was, changed, value);
  compare_json("f.json", was, unequal, key);
  EXPECT_TRUE(places(none).empty());
  EXPECT_EQ(places(value), std::vector<std::string>{"f.json: gain_percent.value"});
  EXPECT_EQ(places(key), std::vector<std::string>{"f.json: error_reduction_percent"});
}

TEST(Comparison, ANewNameOfAValueIsNoDifference) {
  const Json was{{"id", "wrong_way_first"}, {"value", 2.0}};
  const Json same{{"name", "inverse_response"}, {"id", "wrong_way_first"}, {"value", 2.0}};
  const Json other{{"name", "at_bound"}, {"id", "wrong_way_first"}, {"value", 2.0}};
  Comparison none{1e-6, 0, {}}, name{1e-6, 0, {}};
  compare_json("f.json", was, same, none);
  compare_json("f.json", was, other, name);
  EXPECT_TRUE(places(none).empty());
  EXPECT_EQ(places(name), std::vector<std::string>{"f.json: name"});
}

TEST(Comparison, AMissingKeyIsADifferenceAlthoughAnotherKeyHasItsValue) {
  const Json was{{"verdict", "adequate"}, {"causes", Json::array()}};
  const Json is{{"warnings", Json::array()}, {"verdict", "adequate"}, {"causes", Json::array()}};
  Comparison comparison{1e-6, 0, {}};
  compare_json("f.json", was, is, comparison);
  EXPECT_EQ(places(comparison), std::vector<std::string>{"f.json: warnings"});
}

TEST(Comparison, ToleranceIsRelativeAndRunTimesPathsAndVersionsAreIgnored) {
  const Json was{
      {"value", 1000.0}, {"wall_s", 3}, {"software", "a"}, {"logs", {{{"path", "x"}, {"samples", 9}}}}};
  const Json is{
      {"value", 1000.5}, {"wall_s", 4}, {"software", "b"}, {"logs", {{{"path", "y"}, {"samples", 9}}}}};
  Comparison wide{1e-3, 0, {}}, narrow{1e-6, 0, {}};
  compare_json("f.json", was, is, wide);
  compare_json("f.json", was, is, narrow);
  EXPECT_TRUE(places(wide).empty());
  EXPECT_EQ(places(narrow), std::vector<std::string>{"f.json: value"});
}

TEST(Comparison, NamesTheWorstCsvLineOfEachColumn) {
  const std::string was = "t,y\n0,1\n1,2\n2,\n";
  Comparison comparison{1e-6, 0, {}};
  compare_csv("s.csv", was, "t,y\n0,1.1\n1,2.5\n2,\n", comparison);
  EXPECT_EQ(places(comparison), std::vector<std::string>{"s.csv: y, line 3"});
  compare_csv("s.csv", was, "t,y\n0,1\n1,2\n2,7\n", comparison);
  EXPECT_EQ(comparison.differences.back().recomputed, "7")
      << "the cell is empty in the report but not in the repeated result";
  compare_csv("s.csv", was, "t,y\n0,1\n", comparison);
  EXPECT_EQ(comparison.differences.back().where, "s.csv: lines");
}

TEST(Comparison, ModelsAreComparedByParameter) {
  document::Problems problems;
  const model::Model twin =
      model::load_model(SOFTGRIP_SOURCE_DIR "/config/models/bench_twin.yaml", problems).value();
  std::vector<double> values = model::flat_values(twin);
  values[0] *= 1.01;
  Comparison comparison{1e-6, 0, {}};
  compare_models("model.yaml", twin, twin, comparison);
  EXPECT_TRUE(comparison.differences.empty());
  compare_models("model.yaml", twin, model::with_values(twin, values), comparison);
  EXPECT_EQ(places(comparison), std::vector<std::string>{"model.yaml: " + model::parameter_path(twin, 0)});
}

}  // namespace
}  // namespace softgrip::tools::verification_test
