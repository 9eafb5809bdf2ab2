// Tests softgrip report --verify with the result files of softgrip identify.

#include "tools/verification/verification.h"

#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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

TEST_F(Verification, WhatWasNotTouchedComesOutAgain) {
  const auto json = verified(0);
  EXPECT_EQ(json["same"], true);
  EXPECT_GT(json["numbers"], 5000) << "the comparison must include the numbers of all series";
  EXPECT_EQ(
      run("validate --model report/model.yaml --data other.csv --at-most-percent 50 --held --out judged"), 0);
  EXPECT_EQ(run("report --verify judged/"), 0) << read("err.txt");
}

TEST_F(Verification, WhatWasChangedIsNamed) {
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

TEST_F(Verification, AMissingOrAnotherLogIsRefusedWithItsHash) {
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

TEST_F(Verification, AFolderThatDoesNotSayHowItWasMadeIsRefused) {
  replace("report/identify.json", "\"call\"", "\"called\"");
  EXPECT_NE(
      verified(3)["missing"][0].get<std::string>().find("does not contain the command that wrote this file"),
      std::string::npos);
  EXPECT_EQ(run("report --verify nowhere"), 3);
  EXPECT_EQ(run("report"), 2);
}

TEST_F(Verification, ACallThatWouldWriteElsewhereIsNotMade) {
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

}  // namespace
}  // namespace softgrip::tools::verification_test
