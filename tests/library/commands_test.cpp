// Tests that the library and the command line give identical results. For the same logs, each result of
// `softgrip` must equal the result of the library bit for bit.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <thread>

#include "library/include/softgrip/diagnose.h"
#include "library/include/softgrip/health.h"
#include "library/include/softgrip/identify.h"
#include "library/include/softgrip/log.h"
#include "library/include/softgrip/softgrip.h"
#include "library/include/softgrip/validate.h"
#include "tests/library/finger.h"
#include "tests/support/files.h"

// GCC 12 incorrectly warns that a new std::stop_source is not initialised.
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"

namespace softgrip::commands_test {
namespace {

using Json = nlohmann::json;

/// Logs that `softgrip simulate` writes, from the model bench_twin and from a model with a different gain.
class LibraryAndCommand : public testing::Test {
 protected:
  LibraryAndCommand() {
    std::filesystem::create_directories(folder_);
    model_ = std::string(SOFTGRIP_SOURCE_DIR) + "/config/models/bench_twin.yaml";
    bench_twin().with("bouc_wen.alpha_mm_per_kpa", 0.26).save(path("stiffer.yaml"));
    run("simulate --model " + model_ + " --input tp1 --rate-hz 20 --noise-mm 0.05 --out " + path("one.csv"));
    run("simulate --model " + model_ + " --input sp1 --rate-hz 20 --noise-mm 0.05 --seed 2 --out " +
        path("two.csv"));
    run("simulate --model " + path("stiffer.yaml") +
        " --input tp1 --rate-hz 20 --noise-mm 0.05 --seed 3 --out " + path("three.csv"));
  }
  ~LibraryAndCommand() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  /// Runs `softgrip` and returns its output. The test fails if the exit code of `softgrip` is not 0.
  std::string run(const std::string& arguments) const {
    const std::string output = path("output");
    const std::string command =
        std::string(SOFTGRIP_PROGRAM) + " " + arguments + " >" + output + " 2>" + path("errors");
    const int status = std::system(command.c_str());
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << test::text_of(path("errors"));
    return test::text_of(output);
  }
  /// Removes the keys `without` from the JSON and returns the result. The values of these keys differ from
  /// call to call.
  static Json plain(const std::string& text, std::initializer_list<const char*> without) {
    Json json = Json::parse(text);
    for (const char* key : without) json.erase(key);
    return json;
  }

  std::string model_;

 private:
  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) /
      ("library_commands_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(LibraryAndCommand, SimulationsAreIdentical) {
  const Log log = read_log(path("one.csv"));
  SimulateOptions options;
  options.noise = 0.05;
  EXPECT_EQ(Model::load(model_).simulate(log.time_s, log.pressure_command_kpa, options), log.displacement);
}

TEST_F(LibraryAndCommand, IdentificationsAreIdentical) {
  const Json expected =
      plain(run("identify --starts 3 --seed 7 --json --data " + path("one.csv") + " " + path("two.csv") +
                " --validate " + path("three.csv") + " --out " + path("out")),
            {"call", "wall_s"});
  IdentifyOptions options;
  options.starts = 3;
  options.seed = 7;
  options.validation = {read_log(path("three.csv"))};
  std::vector<std::string> stages;
  options.progress = [&](const std::string& stage) { stages.push_back(stage); };
  const Identification found = identify({read_log(path("one.csv")), read_log(path("two.csv"))}, options);
  EXPECT_EQ(plain(found.json, {"call", "wall_s"}), expected);
  EXPECT_EQ(found.model.yaml(), Model::load(path("out/model.yaml")).yaml());
  EXPECT_EQ(found.fit.size(), 2U);
  EXPECT_EQ(found.fit[1].time_s.size(), found.fit[1].prediction.size());
  EXPECT_EQ(found.validation.size(), 1U);
  EXPECT_FALSE(stages.empty());
  EXPECT_NE(found.html.find("<html"), std::string::npos);
}

TEST_F(LibraryAndCommand, IdentificationsWithAutomaticStructureAreIdentical) {
  const Json expected = plain(
      run("identify --structure auto --starts 3 --json --data " + path("one.csv") + " --out " + path("out")),
      {"call", "wall_s"});
  IdentifyOptions options;
  options.structure = Structure::automatic;
  options.starts = 3;
  EXPECT_EQ(plain(identify({read_log(path("one.csv"))}, options).json, {"call", "wall_s"}), expected);
}

TEST_F(LibraryAndCommand, ValidationsAreIdentical) {
  const std::string stiffer = path("stiffer.yaml");
  const Json expected =
      plain(run("validate --json --model " + stiffer + " --data " + path("one.csv") + " " + path("two.csv")),
            {"call", "wall_s"});
  const Validation found =
      validate(Model::load(stiffer), {read_log(path("one.csv")), read_log(path("two.csv"))});
  EXPECT_EQ(plain(found.json, {"call", "wall_s"}), expected);
  EXPECT_GT(found.predictions.at(0).rmse, 0.1);
}

TEST_F(LibraryAndCommand, DiagnosesAreIdentical) {
  run("identify --starts 3 --data " + path("one.csv") + " --out " + path("fit"));
  const std::string fitted = path("fit/model.yaml");
  const auto differing = {
      "call", "wall_s",          "stages_s",    "software",           "given",       "model",
      "logs", "next_experiment", "closed_loop", "experiments_judged", "gauge_check", "experiment_advice"};
  const Json expected = plain(run("diagnose --no-closed-loop --json --model " + fitted + " --data " +
                                  path("one.csv") + " --out " + path("out")),
                              differing);
  const Diagnosis found = diagnose(Model::load(fitted), {read_log(path("one.csv"))});
  EXPECT_EQ(plain(found.json, differing), expected);
  EXPECT_EQ(found.verdict, "cause_found");
  EXPECT_EQ(found.extended.yaml(), Model::load(path("out/model.yaml")).yaml());
  ASSERT_FALSE(found.causes.empty());
  EXPECT_EQ(found.causes[0].id, "transport_delay");
}

TEST_F(LibraryAndCommand, ChangeDiagnosesAreIdenticalAndDoNotUseDriveAndBegin) {
  const Json expected =
      plain(run("diagnose --json --model " + model_ + " --healthy " + path("one.csv") + " " +
                path("two.csv") + " --data " + path("three.csv") + " --out " + path("out")),
            {"wall_s", "made_of"});
  const std::vector<Log> healthy{read_log(path("one.csv")), read_log(path("two.csv"))};
  const std::vector<Log> later{read_log(path("three.csv"))};
  ASSERT_TRUE(later.front().pressure_kpa.empty());
  const Change found = diagnose_change(Model::load(model_), healthy, later);
  EXPECT_EQ(plain(found.json, {"wall_s"}), expected);
  EXPECT_NE(found.verdict, "unchanged");
  ASSERT_FALSE(found.causes.empty());
  ASSERT_EQ(found.causes.size(), expected["causes"].size());
  for (std::size_t i = 0; i < found.causes.size(); ++i) {
    const Json& reduction = expected["causes"][i]["heldout_error_reduction_percent"];
    EXPECT_EQ(found.causes[i].error_reduction_percent, reduction["value"].get<double>());
    EXPECT_EQ(found.causes[i].error_reduction_ci95.lower, reduction["ci95"][0].get<double>());
    EXPECT_EQ(found.causes[i].error_reduction_ci95.upper, reduction["ci95"][1].get<double>());
  }
  DiagnoseOptions options;
  options.use = {Drive::measured, Begin::unknown, false};
  EXPECT_EQ(plain(diagnose_change(Model::load(model_), healthy, later, options).json, {"wall_s"}), expected);
}

/// Starts `work` and requests its stop after the duration `after`. Returns the time [s] from the request to
/// the end of `work`. The test fails if `work` does not end with the exception Cancelled.
template <class Work>
double time_to_stop_s(std::chrono::milliseconds after, Work work) {
  std::stop_source stop;
  std::chrono::steady_clock::time_point asked;
  std::jthread other([&] {
    std::this_thread::sleep_for(after);
    asked = std::chrono::steady_clock::now();
    stop.request_stop();
  });
  EXPECT_THROW(work(stop.get_token()), Cancelled);
  const auto ended = std::chrono::steady_clock::now();
  other.join();
  return std::chrono::duration<double>(ended - asked).count();
}

TEST_F(LibraryAndCommand, AStopEndsLongComputationsWithinASecond) {
  const Model model = Model::load(path("stiffer.yaml"));
  const std::vector<Log> logs{read_log(path("one.csv")), read_log(path("two.csv"))};
  std::vector<double> times_s;
  for (const auto structure : {Structure::start, Structure::automatic}) {
    times_s.push_back(time_to_stop_s(std::chrono::milliseconds(20), [&](const std::stop_token& stop) {
      IdentifyOptions options;
      options.starts = 10000;
      options.structure = structure;
      options.stop = stop;
      (void)identify(logs, options);
    }));
  }
  const Course course = sine(0, 40, 0.1, 300'000, 0.005);
  Log long_log;
  long_log.time_s = course.time_s;
  long_log.pressure_command_kpa = course.value;
  long_log.displacement = model.simulate(course.time_s, course.value, {.noise = 0.05});
  // validate() first checks the log as check() does. The stop is requested after this check.
  const auto began = std::chrono::steady_clock::now();
  check(long_log);
  const std::chrono::duration<double, std::milli> checked_ms = std::chrono::steady_clock::now() - began;
  const std::chrono::milliseconds delay(std::lround(1.3 * checked_ms.count()));
  times_s.push_back(time_to_stop_s(delay, [&](const std::stop_token& stop) {
    (void)validate(model, {long_log}, {.begin = Begin::unknown}, stop);
  }));
  for (const int after_ms : {0, 2, 10}) {
    times_s.push_back(time_to_stop_s(std::chrono::milliseconds(after_ms), [&](const std::stop_token& stop) {
      DiagnoseOptions options;
      options.null_campaigns = 1000;
      options.stop = stop;
      (void)diagnose(model, logs, options);
    }));
    times_s.push_back(time_to_stop_s(std::chrono::milliseconds(after_ms), [&](const std::stop_token& stop) {
      DiagnoseOptions options;
      options.stop = stop;
      (void)diagnose_change(Model::load(model_), logs, {read_log(path("three.csv"))}, options);
    }));
  }
  ASSERT_EQ(times_s.size(), 9U);
  for (const double time_s : times_s) EXPECT_LT(time_s, 1);
}

TEST_F(LibraryAndCommand, HealthResultsAreIdentical) {
  run("baseline --data " + path("one.csv") + " " + path("two.csv") + " --model " + model_ + " --out " +
      path("base"));
  const std::vector<std::string> recordings{path("one.csv"), path("two.csv"), path("three.csv")};
  const Json expected =
      plain(run("health " + recordings[0] + " " + recordings[1] + " " + recordings[2] + " --baseline " +
                path("base") + " --points run --json --out " + path("health")),
            {"made", "made_unix_s"});
  HealthOptions options;
  options.points = HealthPoints::run;
  options.scores = path("scores.jsonl");
  std::vector<std::string> stages;
  options.progress = [&](const std::string& stage) { stages.push_back(stage); };
  const Health found = health(recordings, path("base"), options);
  EXPECT_EQ(plain(found.json, {"made", "made_unix_s"}), expected);
  EXPECT_EQ(test::text_of(options.scores), test::text_of(path("health/health-scores.jsonl")));
  ASSERT_EQ(found.fingers.size(), 1U);
  EXPECT_EQ(found.fingers[0].html, test::text_of(path("health/health.html")));
  EXPECT_EQ(found.fingers[0].points.size(), 3U);
  ASSERT_EQ(found.fingers[0].indicators.size(), 9U);
  EXPECT_EQ(found.fingers[0].indicators[0].values.size(), 3U);
  EXPECT_EQ(found.fingers[0].indicators[0].value,
            expected["fingers"][0]["numbers"]["gain_mm"]["value"].get<double>());
  EXPECT_EQ(stages.back(), "recording 3 of 3");
  stages.clear();
  (void)health(recordings, path("base"), options);
  EXPECT_TRUE(stages.empty()) << "no recording is evaluated again because all scores are stored";
}

TEST_F(LibraryAndCommand, HealthThrowsForInvalidInputAndOnCancellation) {
  run("baseline --data " + path("one.csv") + " --model " + model_ + " --out " + path("base"));
  const std::vector<std::string> recordings{path("one.csv")};
  EXPECT_THROW((void)health({}, path("base")), InvalidArgument);
  EXPECT_THROW((void)health(recordings, ""), InvalidArgument);
  EXPECT_THROW((void)health(recordings, path("base"), {.false_alarm_points = 19}), InvalidArgument);
  EXPECT_THROW((void)health(recordings, path("nothing")), FileError);
  EXPECT_THROW((void)health(recordings, path("base"), {.notes = path("nothing")}), FileError);
  EXPECT_THROW((void)health(recordings, path("base"), {.scores = path("base")}), FileError);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)health(recordings, path("base"), {.stop = stop.get_token()}), Cancelled);
  std::ofstream(path("base/model.yaml")) << "changed\n";
  EXPECT_THROW((void)health(recordings, path("base")), FileError);
}

TEST_F(LibraryAndCommand, AChoiceOfTheStructureRefusesTheSettingsOfAGivenStructure) {
  const std::vector<Log> logs{read_log(path("one.csv"))};
  const auto refused = [&](IdentifyOptions options) {
    options.structure = Structure::automatic;
    try {
      (void)identify(logs, options);
    } catch (const InvalidArgument& error) {
      return error.argument();
    }
    return std::string();
  };
  EXPECT_EQ(refused({.start = Model::load(model_)}), "start");
  EXPECT_EQ(refused({.branches = 3}), "branches");
  EXPECT_EQ(refused({.fixed = {"kelvin_voigt.k0_kpa_per_mm"}}), "fixed");
  EXPECT_EQ(refused({.fixed = {"no.such"}}), "fixed");
  EXPECT_EQ(refused({.free = {"kelvin_voigt.k0_kpa_per_mm"}}), "free");
  EXPECT_EQ(refused({.robust = true}), "robust");
}

TEST_F(LibraryAndCommand, InvalidInputThrowsAnException) {
  const Log log = read_log(path("one.csv"));
  EXPECT_THROW((void)identify({}), InvalidArgument);
  for (const std::string argument : {"fixed", "free"}) {
    IdentifyOptions unknown{.fixed = {"kelvin_voigt.k0_kpa_per_mm"}};
    (argument == "fixed" ? unknown.fixed : unknown.free) = {"kelvin_voigt.k0_kpa_per_m"};
    try {
      (void)identify({log}, unknown);
      FAIL();
    } catch (const InvalidArgument& error) {
      EXPECT_EQ(error.argument(), argument);
      EXPECT_NE(std::string(error.what()).find("did you mean 'kelvin_voigt.k0_kpa_per_mm'?"),
                std::string::npos)
          << error.what();
    }
  }
  EXPECT_THROW((void)identify({log}, {.start = Model::load(model_), .fixed = {"no.such"}}), InvalidArgument);
  EXPECT_THROW((void)identify({log}, {.starts = 0}), InvalidArgument);
  EXPECT_THROW((void)identify({log}, {.use = {.drive = Drive::measured}}), InvalidArgument);
  Log angle = log;
  angle.unit = Unit::deg;
  EXPECT_THROW((void)validate(Model::load(model_), {angle}), InvalidArgument);
  IdentifyOptions options;
  options.progress = [](const std::string&) { throw std::runtime_error("enough"); };
  EXPECT_THROW((void)identify({log}, options), std::runtime_error);
}

}  // namespace
}  // namespace softgrip::commands_test
