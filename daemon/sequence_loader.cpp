#include "daemon/sequence_loader.h"

#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "control/sequence_file.h"
#include "model/document/sha256.h"

namespace softgrip::daemon {

namespace {

/// One step down from the directory, nothing hidden.
bool is_plain_name(const std::string& name) {
  return !name.empty() && name.front() != '.' && name.find('/') == std::string::npos &&
         name.find('\0') == std::string::npos;
}

}  // namespace

SequenceLoader::SequenceLoader(const control::RigSettings& rig, std::string directory)
    : rig_(rig), directory_(std::move(directory)) {}

SequenceLoader::Result SequenceLoader::load_file(const std::string& path) const {
  document::Problems problems;
  auto sequence = control::load_sequence(path, problems);
  return fit(std::move(sequence), std::move(problems));
}

SequenceLoader::Result SequenceLoader::load_named(const std::string& name) const {
  if (!is_plain_name(name)) {
    document::Problems problems;
    problems.add({name,
                  {},
                  "",
                  "this is no name of a file in the daemon's sequence directory",
                  fmt::format("a file of {}, or send the text itself", directory_)});
    return tl::unexpected(std::move(problems));
  }
  std::string path = directory_ + "/" + name;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) path += ".yaml";
  return load_file(path);
}

SequenceLoader::Result SequenceLoader::load_text(const std::string& name, const std::string& text) const {
  document::Problems problems;
  const document::Document document = document::parse(name, text, problems);
  auto sequence = control::read_sequence(document, problems);
  return fit(std::move(sequence), std::move(problems));
}

SequenceLoader::Result SequenceLoader::fit(std::optional<control::Sequence> sequence,
                                           document::Problems problems) const {
  if (!sequence || !problems.empty()) return tl::unexpected(std::move(problems));
  auto prepared = control::prepare(*sequence, rig_, problems);
  if (!prepared || !problems.empty()) return tl::unexpected(std::move(problems));
  auto loaded = std::make_shared<LoadedSequence>();
  loaded->sha256 = document::sha256(sequence->text);
  loaded->written = std::move(*sequence);
  loaded->prepared = std::move(*prepared);
  return loaded;
}

}  // namespace softgrip::daemon
