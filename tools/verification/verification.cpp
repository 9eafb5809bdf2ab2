#include "tools/verification/verification.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "base/files.h"
#include "base/json.h"
#include "base/numbers.h"
#include "base/sha256.h"
#include "document/problem.h"
#include "model/file/model_file.h"
#include "sysid/changes/baseline_folder.h"
#include "sysid/logs/csv_text.h"

namespace softgrip::tools {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t largest_file = std::size_t{512} * 1024 * 1024;

/// Runs the program and discards its standard output. Returns its exit code, or -1 if it cannot run.
int called(const std::string& program, std::vector<std::string> words) {
  words.insert(words.begin(), program);
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failed = ::posix_spawn(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) return -1;
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string model_hash_of(const std::string& path) {
  document::Problems problems;
  const auto model = model::load_model(path, problems);
  return model ? model::model_hash(*model) : std::string();
}

std::string sha256_of(const std::string& path) {
  const auto bytes = read_file(is_folder(path) ? path + "/run.csv" : path, largest_file);
  return bytes ? sha256(*bytes) : std::string();
}

/// Returns the hashes of the logs in the folder of a baseline, or "" if the folder contains no valid
/// baseline.
std::string baseline_hashes(const std::string& folder) {
  const auto baseline = sysid::read_baseline(folder);
  std::string joined;
  if (!baseline) return joined;
  for (const std::string& log : baseline->logs) joined += sha256_of(log) + " ";
  return joined;
}

/// Returns the part of a report that describes how it was made. In the report of a change, this part has its
/// own key.
const Json& origin_of(const Json& report) {
  return report.contains("made_of") ? json_member(report, "made_of") : report;
}

class Verifier {
 public:
  Verifier(const std::string& folder, const std::string& program, double tolerance)
      : folder_(folder), program_(program) {
    result_.comparison.tolerance = tolerance;
  }

  Verification run() {
    if (read() && find_inputs()) compute_again();
    return std::move(result_);
  }

 private:
  bool missing(std::string sentence) {
    result_.missing.push_back(std::move(sentence));
    return false;
  }

  bool read() {
    std::string names;
    for (const ReportKind& kind : report_kinds) {
      names += (names.empty() ? "" : ", ") + std::string(kind.json);
      if (is_there(folder_ / kind.json)) kind_ = &kind;
    }
    if (kind_ == nullptr) return missing("no report in " + folder_.string() + ": none of " + names);
    const std::string path = (folder_ / kind_->json).string();
    const auto text = read_file(path, largest_file);
    if (!text) return missing(text.error());
    json_ = parse_json<Json>(*text);
    if (!json_.is_object()) return missing(path + " cannot be read as JSON");
    result_.reported_by = json_text(made_of(), "software");
    const Json& call = json_member(made_of(), "call");
    for (const Json& word : call) {
      if (!word.is_string()) return missing(path + ": the value of the key `call` is not a list of texts");
      call_.push_back(word.get<std::string>());
    }
    if (call_.empty())
      return missing(path +
                     " does not contain the command that wrote this file (key `call`), because an older "
                     "version or an investigation wrote the file");
    const bool writes_elsewhere = std::any_of(call_.begin(), call_.end(), [](const std::string& word) {
      return word.starts_with("--out") || word.starts_with("--figures");
    });
    if (call_.front() != kind_->command || writes_elsewhere)
      return missing(path + ": the key `call` does not contain a call of softgrip " + kind_->command);
    return true;
  }

  /// Returns the hash that the report states for a file. `option` is the command-line option whose value is
  /// this file.
  [[nodiscard]] std::string hash_of(const std::string& option, const std::string& path) const {
    const Json& healthy = json_member(made_of(), "healthy");
    if (option == "--baseline") return joined_hashes(healthy);
    for (const Json* logs :
         {&json_member(made_of(), "logs"), &json_member(json_member(json_, "validation"), "logs"), &healthy,
          &json_member(made_of(), "data")}) {
      for (const Json& log : *logs) {
        if (json_text(log, "path") == path) return json_text(log, "sha256");
      }
    }
    if (option == "--gauge") return json_text(json_member(json_, "gauge"), "sha256");
    if (option == "--start") return json_text(json_member(json_, "start"), "hash");
    if (option == "--model")
      return json_text(json_member(made_of(), made_of().contains("given") ? "given" : "model"), "hash");
    return {};
  }

  /// Returns the hashes of all logs in the list, in the form of baseline_hashes().
  static std::string joined_hashes(const Json& logs) {
    std::string joined;
    for (const Json& log : logs) joined += json_text(log, "sha256") + " ";
    return joined;
  }

  /// Returns the current hash of the file or folder that is the value of an option.
  static std::string hash_now(const std::string& option, const std::string& path) {
    if (option == "--start" || option == "--model") return model_hash_of(path);
    return option == "--baseline" ? baseline_hashes(path) : sha256_of(path);
  }

  /// Replaces the path of every input file in the command line by the path at which the file exists now.
  bool find_inputs() {
    static const std::set<std::string> takes_files{"--data",  "--validate", "--start",   "--model",
                                                   "--gauge", "--healthy",  "--baseline"};
    std::string option;
    for (std::size_t i = 1; i < call_.size(); ++i) {
      if (call_[i].starts_with("--")) {
        option = call_[i];
      } else if (takes_files.contains(option)) {
        find(option, call_[i]);
      }
    }
    return result_.missing.empty();
  }

  void find(const std::string& option, std::string& path) {
    const bool is_model = option == "--start" || option == "--model";
    const std::string wanted = hash_of(option, path);
    const fs::path name = fs::path(path).filename();
    std::string other;
    for (const fs::path& candidate : {fs::path(path), folder_ / name, folder_.parent_path() / name}) {
      if (!is_there(candidate)) continue;
      const std::string hash = hash_now(option, candidate.string());
      if (hash == wanted && !hash.empty()) {
        path = candidate.string();
        return;
      }
      if (other.empty())
        other = candidate.string() + " differs from the file that the report used (" + hash + ")";
    }
    missing(std::string(is_model                 ? "model "
                        : option == "--gauge"    ? "gauge file "
                        : option == "--baseline" ? "baseline "
                                                 : "log ") +
            path + ", " + (is_model ? "hash " : "sha256 ") + wanted + ": " +
            (other.empty() ? "not found" : other));
  }

  void compute_again() {
    const ScratchFolder scratch;
    std::vector<std::string> words = call_;
    words.insert(words.end(), {"--out", scratch.path()});
    const int code = scratch.path().empty() ? -1 : called(program_, words);
    const fs::path again(scratch.path());
    const auto text = read_file((again / kind_->json).string(), largest_file);
    const Json json = text ? parse_json<Json>(*text) : Json();
    if (!json.is_object()) {
      missing("softgrip " + std::string(kind_->command) + " failed: exit code " + std::to_string(code));
      return;
    }
    result_.recomputed_by = json_text(origin_of(json), "software");
    compare_json(kind_->json, json_, json, result_.comparison);
    compare_series(again);
    compare_model(again);
  }

  void compare_series(const fs::path& again) {
    std::error_code ended;
    for (fs::directory_iterator at(again, ended); !ended && at != fs::directory_iterator();
         at.increment(ended)) {
      const fs::directory_entry& entry = *at;
      if (!is_there(entry.path() / "series.csv")) continue;
      const std::string name = entry.path().filename().string() + "/series.csv";
      const auto was = read_file((folder_ / name).string(), largest_file);
      const auto is = read_file((again / name).string(), largest_file);
      if (was && is) {
        compare_csv(name, *was, *is, result_.comparison);
      } else {
        result_.comparison.compare(name, std::string(was ? "is there" : "is missing"), "is there");
      }
    }
  }

  void compare_model(const fs::path& again) {
    if (!is_there(again / "model.yaml")) return;
    document::Problems problems;
    const auto was = model::load_model((folder_ / "model.yaml").string(), problems);
    const auto is = model::load_model((again / "model.yaml").string(), problems);
    if (was && is) {
      compare_models("model.yaml", *was, *is, result_.comparison);
    } else {
      result_.comparison.compare("model.yaml", std::string("is missing or damaged"), "is there");
    }
  }

  [[nodiscard]] const Json& made_of() const { return origin_of(json_); }

  fs::path folder_;
  std::string program_;
  const ReportKind* kind_ = nullptr;
  Json json_;
  std::vector<std::string> call_;
  Verification result_;
};

using Json = nlohmann::ordered_json;

/// Keys that may differ between two runs with the same result.
constexpr std::array<std::string_view, 8> not_compared{"wall_s", "stages_s", "software", "path",
                                                       "file",   "call",     "hash",     "source"};

double relative_difference(double a, double b) {
  const double scale = std::max(std::abs(a), std::abs(b));
  return scale > 0 ? std::abs(a - b) / scale : 0;
}

std::string text_of(const Json& value) {
  return value.is_number() ? shortest(value.get<double>()) : value.dump();
}

/// Returns true if the values are equal, or if `former` is the deprecated name of the value `present`.
bool is_same_value(const Json& present, const Json& former) {
  return present == former || (present == "inverse_response" && former == "wrong_way_first");
}

/// Returns true if the key is a new name of a key of the report. An earlier version wrote the report with the
/// deprecated name only. The recomputed result contains the same value under both names, the deprecated name
/// directly after the new name.
bool is_new_name(const std::string& key, const Json& reported, const Json& recomputed) {
  const auto at = recomputed.find(key);
  if (reported.contains(key) || at == recomputed.end()) return false;
  const auto next = std::next(at);
  return next != recomputed.end() && reported.contains(next.key()) && is_same_value(*at, *next);
}

void compare_values(const std::string& where, const Json& reported, const Json& recomputed,
                    Comparison& comparison) {
  if (reported.is_number() && recomputed.is_number())
    return comparison.compare(where, reported.get<double>(), recomputed.get<double>());
  if (reported.is_object() && recomputed.is_object()) {
    std::set<std::string> keys;
    for (const Json* one : {&reported, &recomputed}) {
      for (const auto& [key, value] : one->items()) keys.insert(key);
    }
    for (const std::string& key : keys) {
      if (std::find(not_compared.begin(), not_compared.end(), key) != not_compared.end()) continue;
      if (is_new_name(key, reported, recomputed)) continue;
      const std::string at = where + (where.ends_with(": ") ? "" : ".") + key;
      compare_values(at, reported.value(key, Json()), recomputed.value(key, Json()), comparison);
    }
    return;
  }
  if (reported.is_array() && recomputed.is_array() && reported.size() == recomputed.size()) {
    for (std::size_t i = 0; i < reported.size(); ++i)
      compare_values(where + "[" + std::to_string(i) + "]", reported[i], recomputed[i], comparison);
    return;
  }
  comparison.compare(where, text_of(reported), text_of(recomputed));
}

}  // namespace

Verification verify_report(const std::string& folder, const std::string& program, double tolerance) {
  const std::string plain = fs::path(folder).lexically_normal().string();
  return Verifier(plain.ends_with('/') && plain.size() > 1 ? plain.substr(0, plain.size() - 1) : plain,
                  program, tolerance)
      .run();
}

void Comparison::compare(const std::string& where, double reported, double recomputed) {
  ++numbers;
  constexpr double next_to_nothing = 1e-12;
  if (reported == recomputed || std::abs(reported - recomputed) < next_to_nothing) return;
  if (relative_difference(reported, recomputed) <= tolerance) return;
  differences.push_back({where, shortest(reported), shortest(recomputed)});
}

void Comparison::compare(const std::string& where, const std::string& reported,
                         const std::string& recomputed) {
  if (reported != recomputed) differences.push_back({where, reported, recomputed});
}

void compare_json(const std::string& file, const Json& reported, const Json& recomputed,
                  Comparison& comparison) {
  compare_values(file + ": ", reported, recomputed, comparison);
}

void compare_csv(const std::string& file, const std::string& reported, const std::string& recomputed,
                 Comparison& comparison) {
  const auto before = sysid::lines_of(reported), after = sysid::lines_of(recomputed);
  if (before.size() != after.size())
    return comparison.compare(file + ": lines", static_cast<double>(before.size()),
                              static_cast<double>(after.size()));
  std::map<std::size_t, std::pair<double, Difference>> worst;  // largest relative difference of each column,
                                                               // by index of the column
  std::vector<sysid::Cell> names, was, is;
  for (std::size_t line = 0; line < before.size(); ++line) {
    const bool whole = sysid::split(before[line], was) && sysid::split(after[line], is);
    if (line == 0) names = was;
    if (!whole || was.size() != is.size() || was.size() != names.size())
      return comparison.compare(file + ": line " + std::to_string(line + 1), std::string(before[line]),
                                std::string(after[line]));
    for (std::size_t i = 0; i < was.size(); ++i) {
      Comparison one{comparison.tolerance, 0, {}};
      const std::string where =
          file + ": " + std::string(names[i].text) + ", line " + std::to_string(line + 1);
      const auto a = to_number(was[i].text), b = to_number(is[i].text);
      if (a && b) {
        one.compare(where, *a, *b);
      } else {
        one.compare(where, std::string(was[i].text), std::string(is[i].text));
      }
      comparison.numbers += one.numbers;
      if (one.differences.empty()) continue;
      const double size = a && b ? std::abs(*a - *b) : HUGE_VAL;
      auto& largest = worst[i];
      if (size > largest.first) largest = {size, std::move(one.differences.front())};
    }
  }
  for (auto& [column, difference] : worst) comparison.differences.push_back(std::move(difference.second));
}

void compare_models(const std::string& file, const model::Model& reported, const model::Model& recomputed,
                    Comparison& comparison) {
  const auto names_of = [](const model::Model& model) {
    std::string names;
    for (std::size_t i = 0; i < model::flat_values(model).size(); ++i)
      names += (i == 0 ? "" : ", ") + model::parameter_path(model, i);
    return names;
  };
  const std::string names = names_of(reported);
  if (names != names_of(recomputed))
    return comparison.compare(file + ": parameters", names, names_of(recomputed));
  const std::vector<double> was = model::flat_values(reported), is = model::flat_values(recomputed);
  for (std::size_t i = 0; i < was.size(); ++i)
    comparison.compare(file + ": " + model::parameter_path(reported, i), was[i], is[i]);
}

}  // namespace softgrip::tools
