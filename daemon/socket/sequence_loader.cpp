#include "daemon/socket/sequence_loader.h"

#include <chrono>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/sha256.h"
#include "control/sequences/prepare_sequence.h"
#include "control/sequences/sequence_file.h"
#include "control/sequences/sequence_plans.h"

namespace softgrip::daemon {

namespace {

/// How long planning may delay a start before it is told: so much of the motion, and a hiccup of the machine.
constexpr double longest_planning_share = 0.1;
constexpr double planning_slack_s = 0.2;

/// One step down from the directory, nothing hidden.
bool is_plain_name(const std::string& name) {
  return !name.empty() && name.front() != '.' && name.find('/') == std::string::npos &&
         name.find('\0') == std::string::npos;
}

}  // namespace

SequenceLoader::SequenceLoader(control::RigSettings rig, std::string directory)
    : rig_(std::move(rig)), directory_(std::move(directory)) {}

SequenceLoader::Result SequenceLoader::load_file(const std::string& path, const std::stop_token& stop) const {
  document::Problems problems;
  auto sequence = control::load_sequence(path, problems);
  return fit(std::move(sequence), std::move(problems), stop);
}

SequenceLoader::Result SequenceLoader::load_named(const std::string& name,
                                                  const std::stop_token& stop) const {
  const auto refused = [](const std::string& file, std::string message, std::string hint) {
    document::Problems problems;
    problems.add({file, {}, "", std::move(message), std::move(hint)});
    return tl::unexpected(std::move(problems));
  };
  if (!is_plain_name(name)) {
    return refused(name, "this is no name of a file in the daemon's sequence directory",
                   fmt::format("a file of {}, or send the text itself", directory_));
  }
  std::string path = directory_ + "/" + name;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) path += ".yaml";
  // A pipe would be waited for.
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored)) {
    return refused(path, "this is no regular file", "a YAML file");
  }
  return load_file(path, stop);
}

SequenceLoader::Result SequenceLoader::load_text(const std::string& name, const std::string& text,
                                                 const std::stop_token& stop) const {
  document::Problems problems;
  const document::Document document = document::parse(name, text, problems);
  auto sequence = control::read_sequence(document, problems);
  return fit(std::move(sequence), std::move(problems), stop);
}

SequenceLoader::Result SequenceLoader::fit(std::optional<control::Sequence> sequence,
                                           document::Problems problems, const std::stop_token& stop) const {
  if (!sequence || !problems.empty()) return tl::unexpected(std::move(problems));
  const auto began = std::chrono::steady_clock::now();
  auto prepared = control::prepare(*sequence, rig_, problems, stop);
  if (!prepared || !problems.empty()) return tl::unexpected(std::move(problems));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
  if (took.count() > longest_planning_share * prepared->planned_s + planning_slack_s) {
    problems.warn(
        {sequence->file,
         {},
         "",
         fmt::format("planning took {:.1f} s for {:.1f} s of motion: every start of this sequence is "
                     "late by that",
                     took.count(), prepared->planned_s),
         "channels with the same model and limits are planned together"});
  }
  auto loaded = std::make_shared<LoadedSequence>();
  loaded->remarks = std::move(problems);
  loaded->sha256 = sha256(sequence->text);
  loaded->written = std::move(*sequence);
  loaded->prepared = std::move(*prepared);
  return loaded;
}

}  // namespace softgrip::daemon
