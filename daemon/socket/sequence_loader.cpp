#include "daemon/socket/sequence_loader.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/sha256.h"
#include "control/sequences/sequence_file.h"
#include "control/sequences/sequence_plans.h"

namespace softgrip::daemon {

namespace {

/// Limit for the duration of planning a sequence: longest_planning_share times the duration of the motion,
/// plus planning_slack_s [s]. The slack allows for the CPU load of other programs. If planning takes longer
/// than this limit, a warning states by how much planning delays the start.
constexpr double longest_planning_share = 0.1;
constexpr double planning_slack_s = 0.2;

/// Returns true if `name` is the name of a file in the directory itself, and not a hidden file. A file in a
/// subdirectory does not count.
bool is_plain_name(const std::string& name) {
  return !name.empty() && name.front() != '.' && name.find('/') == std::string::npos &&
         name.find('\0') == std::string::npos;
}

constexpr std::string_view ending = ".yaml";

/// Returns a hint with the existing name that is most similar to `name`, or with a list of all existing
/// names.
std::string hint_of(const std::string& name, const std::string& directory,
                    const std::vector<std::string>& names) {
  if (names.empty()) return fmt::format("there are no sequences in {}", directory);
  const std::string near = document::nearest(name, names);
  return fmt::format("{}in {}: {}", near.empty() ? "" : fmt::format("did you mean '{}'? ", near), directory,
                     fmt::join(names, ", "));
}

}  // namespace

SequenceLoader::SequenceLoader(control::RigSettings rig, std::string directory)
    : rig_(std::move(rig)), directory_(std::move(directory)) {}

SequenceLoader::Result SequenceLoader::load_file(const std::string& path, Arguments arguments,
                                                 const std::stop_token& stop) const {
  document::Problems problems;
  auto sequence = control::load_sequence(path, problems, arguments);
  return prepare_for_rig(std::move(sequence), std::move(problems), stop);
}

SequenceLoader::Result SequenceLoader::load_named(const std::string& name, Arguments arguments,
                                                  const std::stop_token& stop) const {
  const auto refused = [](const std::string& file, std::string message, std::string hint) {
    document::Problems problems;
    problems.add(
        {.file = file, .at = {}, .line_text = "", .message = std::move(message), .hint = std::move(hint)});
    return tl::unexpected(std::move(problems));
  };
  if (!is_plain_name(name)) {
    return refused(
        name, "this is not the name of a file in the daemon's sequence directory",
        fmt::format("give the name of a file in {}, or send the text of the sequence", directory_));
  }
  std::string path = directory_ + "/" + name;
  std::error_code ignored;
  if (name.ends_with(ending)) {
    if (!std::filesystem::exists(path, ignored))
      return refused(path, "there is no such file, and the client sent no text of a file with this name",
                     hint_of(name.substr(0, name.size() - ending.size()), directory_, names()));
    return load_file(path, arguments, stop);
  }
  if (!std::filesystem::exists(path, ignored)) path += ending;
  if (!std::filesystem::exists(path, ignored)) {
    return refused(path, fmt::format("there is no sequence '{}'", name), hint_of(name, directory_, names()));
  }
  return load_file(path, arguments, stop);
}

SequenceLoader::Result SequenceLoader::load_text(const std::string& name, const std::string& text,
                                                 Arguments arguments, const std::stop_token& stop) const {
  document::Problems problems;
  const document::Document document = document::parse(name, text, problems);
  auto sequence = control::read_sequence(document, problems, arguments);
  return prepare_for_rig(std::move(sequence), std::move(problems), stop);
}

std::vector<std::string> SequenceLoader::names() const {
  std::vector<std::string> names;
  std::error_code error;
  std::filesystem::directory_iterator entry(directory_, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    std::error_code ignored;
    if (!is_plain_name(name) || !name.ends_with(ending) || !entry->is_regular_file(ignored)) continue;
    names.push_back(name.substr(0, name.size() - ending.size()));
  }
  std::sort(names.begin(), names.end());
  if (names.size() > most_listed) names.resize(most_listed);
  return names;
}

std::vector<SequenceLoader::SequenceInfo> SequenceLoader::list() const {
  std::vector<SequenceInfo> list;
  for (const std::string& name : names()) {
    SequenceInfo& info = list.emplace_back();
    info.name = name;
    auto sequence = control::load_sequence(directory_ + "/" + name + std::string(ending), info.problems);
    if (!sequence) continue;
    info.about = std::move(sequence->about);
    info.parameters = std::move(sequence->parameters);
  }
  return list;
}

SequenceLoader::Result SequenceLoader::prepare_for_rig(std::optional<control::Sequence> sequence,
                                                       document::Problems problems,
                                                       const std::stop_token& stop) const {
  if (!sequence || !problems.empty()) return tl::unexpected(std::move(problems));
  const auto began = std::chrono::steady_clock::now();
  auto prepared = control::prepare(*sequence, rig_, problems, stop);
  if (!prepared || !problems.empty()) return tl::unexpected(std::move(problems));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  if (took.count() > longest_planning_share * prepared->planned_s + planning_slack_s) {
    problems.warn(
        {.file = sequence->file,
         .at = {},
         .line_text = "",
         .message = fmt::format("planning took {:.1f} s for {:.1f} s of motion; every start of the sequence "
                                "is delayed by the planning",
                                took.count(), prepared->planned_s),
         .hint = "channels with the same model and limits are planned together"});
  }
  auto loaded = std::make_shared<LoadedSequence>();
  loaded->remarks = std::move(problems);
  loaded->sha256 = sha256(sequence->text);
  loaded->written = std::move(*sequence);
  loaded->prepared = std::move(*prepared);
  return loaded;
}

}  // namespace softgrip::daemon
