#include "rig/check.h"

#include <algorithm>
#include <array>
#include <optional>

#include "control/sequences/prepare_sequence.h"
#include "control/sequences/sequence_file.h"
#include "model/file/model_file.h"
#include "rig/board_map_file.h"
#include "rig/rig_file.h"

namespace softgrip::rig {

namespace {

/// Keys by which a kind of file is known. `name` stands in all of them and tells nothing.
struct Signature {
  FileKind kind;
  std::vector<std::string> keys;
};

const std::array<Signature, 4>& signatures() {
  static const std::array<Signature, 4> all{
      Signature{FileKind::rig,
                {"board", "channels", "safety", "faults", "rate_hz", "plausibility", "detection", "rest",
                 "model_health", "real_time", "recorder", "socket", "loop"}},
      Signature{FileKind::board_map,
                {"address_base", "word_order", "inputs", "outputs", "fc23", "readable_gap", "input_status",
                 "read_back", "watchdog", "setup"}},
      Signature{FileKind::model, {"valve", "actuator", "load", "sensor"}},
      Signature{FileKind::sequence, {"steps", "about", "interlock", "channels", "parameters"}},
  };
  return all;
}

/// How many keys of the document belong to a kind; a misspelt one counts half.
std::size_t score(const document::Document& document, const Signature& signature) {
  std::size_t points = 0;
  for (const document::Node::Entry& entry : document.root.entries) {
    const auto& keys = signature.keys;
    if (std::find(keys.begin(), keys.end(), entry.key) != keys.end()) {
      points += 2;
    } else if (entry.key.size() > 3 && !document::nearest(entry.key, keys).empty()) {
      points += 1;
    }
  }
  return points;
}

void report_unknown(const document::Document& document, document::Problems& problems) {
  problems.add(document.problem(
      document.root.at, "this is neither a rig nor a board map nor a model nor a sequence",
      "a rig has `board` and `channels`, a board map `inputs` and `outputs`, a model `actuator`, a sequence "
      "`steps`"));
}

/// What is kept of the files to be fitted to each other.
struct Read {
  std::vector<RigFile> rigs;
  std::vector<control::Sequence> sequences;
};

void read_as(const document::Document& document, std::span<const control::Argument> arguments,
             CheckedFile& file, document::Problems& problems, Read& read) {
  const auto keep_name = [&](const auto& value) {
    if (value) file.name = value->name;
  };
  switch (file.kind) {
    case FileKind::rig: {
      auto rig = read_rig(document, problems);
      keep_name(rig);
      if (rig) read.rigs.push_back(std::move(*rig));
      break;
    }
    case FileKind::board_map:
      keep_name(read_board_map(document, problems));
      break;
    case FileKind::model:
      keep_name(model::read_model(document, problems));
      break;
    case FileKind::sequence: {
      auto sequence = control::read_sequence(document, problems, arguments);
      keep_name(sequence);
      if (sequence) read.sequences.push_back(std::move(*sequence));
      break;
    }
    case FileKind::unknown:
      break;
  }
}

void fit_sequences(const Read& read, document::Problems& problems) {
  for (const control::Sequence& sequence : read.sequences) {
    for (const RigFile& rig : read.rigs) {
      static_cast<void>(control::prepare(sequence, rig.settings, problems));
      control::check_ranges(sequence, rig.settings, problems);
    }
  }
}

std::size_t count_of(const std::vector<document::Problem>& list, const std::string& path) {
  const auto of_file = [&](const document::Problem& problem) { return problem.file == path; };
  return static_cast<std::size_t>(std::count_if(list.begin(), list.end(), of_file));
}

}  // namespace

std::string_view name_of(FileKind kind) noexcept {
  constexpr std::array<std::string_view, 5> names{"unknown", "rig", "board map", "model", "sequence"};
  return names[static_cast<std::size_t>(kind)];
}

FileKind kind_of(const document::Document& document, document::Problems& problems) {
  FileKind best = FileKind::unknown;
  std::size_t best_points = 0;
  for (const Signature& signature : signatures()) {
    const std::size_t points = score(document, signature);
    if (points > best_points) {
      best = signature.kind;
      best_points = points;
    }
  }
  // What could not be read to the end has its problem already.
  if (best == FileKind::unknown && document.complete) report_unknown(document, problems);
  return best;
}

CheckReport check_files(std::span<const std::string> paths, std::span<const control::Argument> arguments) {
  CheckReport report;
  document::Problems problems;
  Read read;
  for (const std::string& path : paths) {
    const auto repeated = [&](const CheckedFile& file) { return file.path == path; };
    if (std::any_of(report.files.begin(), report.files.end(), repeated)) continue;
    CheckedFile& file = report.files.emplace_back();
    file.path = path;
    const document::Document document = document::parse_file(path, problems);
    file.kind = kind_of(document, problems);
    read_as(document, arguments, file, problems, read);
  }
  fit_sequences(read, problems);
  // A model that two rigs name, or that is checked itself too, was read more than once.
  report.problems = problems.without_repeats();
  for (CheckedFile& file : report.files) {
    file.errors = count_of(report.problems.list(), file.path);
    file.warnings = count_of(report.problems.warnings(), file.path);
  }
  return report;
}

}  // namespace softgrip::rig
