#include "rig/check.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "base/enum_table.h"
#include "base/text.h"
#include "control/sequences/sequence_file.h"
#include "model/file/model_file.h"
#include "rig/board_map_file.h"
#include "rig/plc_file/settings.h"
#include "rig/web_file/settings.h"

namespace softgrip::rig {

namespace {

/// The keys that identify one kind of file. The key `name` is not listed, because files of all kinds have it.
struct Signature {
  FileKind kind;
  std::vector<std::string> keys;
};

const std::array<Signature, 6>& signatures() {
  static const std::array<Signature, 6> all{
      Signature{FileKind::rig,
                {"board", "channels", "channel_defaults", "safety", "faults", "rate_hz", "plausibility",
                 "detection", "rest", "model_health", "real_time", "recorder", "socket", "loop"}},
      Signature{FileKind::board_map,
                {"address_base", "word_order", "max_registers", "inputs", "outputs", "fc23", "readable_gap",
                 "input_status", "read_back", "watchdog", "setup"}},
      Signature{FileKind::model, {"valve", "actuator", "load", "sensor"}},
      Signature{FileKind::sequence, {"steps", "about", "interlock", "channels", "parameters"}},
      Signature{FileKind::plc, {"socket", "listen", "master", "recipes", "registers"}},
      Signature{FileKind::web, {"daemon", "listen", "access", "recordings"}},
  };
  return all;
}

/// Returns the score of a document for one kind of file: 2 points for each key of this kind, and 1 point for
/// each misspelt key.
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
  problems.add(
      document.problem(document.root.at,
                       "this file is not a rig, a board map, a model, a sequence, a file of softgrip-plc or "
                       "a file of softgrip-web",
                       "required keys: `board` and `channels` in a rig, `inputs` and `outputs` in a "
                       "board map, `actuator` in a model, `steps` in a sequence, `registers` in a file of "
                       "softgrip-plc, `access` in a file of softgrip-web"));
}

/// A rig, and the document that contains the locations of its keys in the file.
struct ReadRig {
  document::Document document;
  RigReading reading;
};

/// The rigs and sequences that were read. After all files are read, each sequence is checked with each rig.
struct Read {
  std::vector<ReadRig> rigs;
  std::vector<control::Sequence> sequences;
};

/// Reads a document as a file of the kind `file.kind`, and stores rigs and sequences in `read`. `parsed` is
/// true if the document has no syntax error, so that it contains the complete file.
void read_as(const document::Document& document, bool parsed, std::span<const control::Argument> arguments,
             CheckedFile& file, document::Problems& problems, Read& read) {
  const auto keep_name = [&](const auto& value) {
    if (value) file.name = value->name;
  };
  switch (file.kind) {
    case FileKind::rig: {
      RigReading reading = read_rig_so_far(document, problems);
      if (reading.accepted) file.name = reading.rig.name;
      reading.accepted = reading.accepted && parsed;
      read.rigs.push_back({document, std::move(reading)});
      break;
    }
    case FileKind::board_map:
      keep_name(read_board_map(document, problems));
      break;
    case FileKind::model:
      keep_name(model::read_rig_model(document, problems));
      break;
    case FileKind::sequence: {
      auto sequence = control::read_sequence(document, problems, arguments);
      keep_name(sequence);
      if (sequence) read.sequences.push_back(std::move(*sequence));
      break;
    }
    case FileKind::plc:
      file.name = plc::read_settings(document, problems).name;
      break;
    case FileKind::web:
      file.name = web::read_settings(document, problems).name;
      break;
    case FileKind::unknown:
      break;
  }
}

/// Returns a substitute for a channel whose model, feedforward, gains or limits could not be read. The limits
/// of the substitute are so wide that every sequence respects them.
control::ChannelSettings anything(const control::ChannelSettings& known) {
  constexpr double wide = 1e6;
  control::ChannelSettings channel;
  channel.name = known.name;
  channel.pid.kp_kpa_per_mm = 1;
  channel.limits = {-wide, wide, wide, wide, -wide, wide, wide};
  channel.feedforward.kind = control::FeedforwardKind::none;
  channel.pressure_measured = true;
  return channel;
}

control::RigSettings known_settings(const RigReading& reading) {
  control::RigSettings settings = reading.rig.settings;
  for (std::size_t i = 0; i < settings.channels.size(); ++i) {
    if (!reading.motion_known[i]) settings.channels[i] = anything(settings.channels[i]);
  }
  return settings;
}

/// A problem of a sequence, and the rig files with which the problem occurs.
struct ProblemWithRigs {
  document::Problem problem;
  std::vector<std::string> rig_files;
};

void add_of_rig(const std::vector<document::Problem>& found, const std::string& rig_file,
                std::vector<ProblemWithRigs>& all) {
  for (const document::Problem& problem : found) {
    const auto known =
        std::ranges::find_if(all, [&](const ProblemWithRigs& one) { return one.problem == problem; });
    if (known == all.end())
      all.push_back({problem, {rig_file}});
    else if (known->rig_files.back() != rig_file)
      known->rig_files.push_back(rig_file);
  }
}

/// Returns the problem. If several rigs are checked, the message names the rig files with this problem.
document::Problem named(const ProblemWithRigs& one, const Read& read) {
  document::Problem problem = one.problem;
  if (read.rigs.size() == 1) return problem;
  problem.message += one.rig_files.size() == 1 ? " (rig file " : " (rig files ";
  problem.message += with_commas(one.rig_files) + ")";
  return problem;
}

void fit_sequences(const Read& read, document::Problems& problems) {
  std::vector<ProblemWithRigs> errors, warnings;
  for (const ReadRig& rig : read.rigs) {
    if (!rig.reading.fits_sequences) continue;
    const control::RigSettings settings = known_settings(rig.reading);
    for (const control::Sequence& sequence : read.sequences) {
      document::Problems found;
      static_cast<void>(control::prepare(sequence, settings, found));
      control::check_ranges(sequence, settings, found);
      add_of_rig(found.list(), rig.document.file, errors);
      add_of_rig(found.warnings(), rig.document.file, warnings);
      if (rig.reading.accepted) compare_grips(sequence, rig.reading.rig, problems);
    }
  }
  for (const ProblemWithRigs& error : errors) problems.add(named(error, read));
  for (const ProblemWithRigs& warning : warnings) problems.warn(named(warning, read));
}

void compare(const Read& read, document::Problems& problems) {
  for (const ReadRig& rig : read.rigs) {
    if (rig.reading.accepted) compare_limits(rig.document, rig.reading.rig, problems);
  }
}

/// A file that must be checked.
struct Candidate {
  std::string path;
  bool from_folder = false;
};

/// Returns the files of a folder and of all its subfolders, in alphabetical order.
std::vector<Candidate> files_below(const std::string& folder) {
  namespace fs = std::filesystem;
  std::vector<Candidate> found;
  std::error_code error;
  const auto skip = fs::directory_options::skip_permission_denied;
  for (auto entry = fs::recursive_directory_iterator(folder, skip, error);
       !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    std::error_code ignored;
    if (entry->path().filename().string().front() == '.') {
      entry.disable_recursion_pending();
    } else if (const auto ending = entry->path().extension(); ending == ".yaml" || ending == ".yml") {
      if (entry->is_regular_file(ignored)) found.push_back({entry->path().string(), true});
    }
  }
  std::sort(found.begin(), found.end(),
            [](const Candidate& a, const Candidate& b) { return a.path < b.path; });
  return found;
}

/// Returns the files that must be checked, each file once.
std::vector<Candidate> candidates_of(std::span<const std::string> paths, document::Problems& problems) {
  std::vector<Candidate> all;
  const auto add = [&](const Candidate& one) {
    const auto repeated = [&](const Candidate& other) { return other.path == one.path; };
    if (std::none_of(all.begin(), all.end(), repeated)) all.push_back(one);
  };
  for (const std::string& path : paths) {
    std::error_code error;
    if (!std::filesystem::is_directory(path, error)) {
      add({path, false});
      continue;
    }
    const std::vector<Candidate> found = files_below(path);
    if (found.empty()) {
      problems.add(
          {path, {}, {}, "this folder and its subfolders contain no readable *.yaml or *.yml file", {}});
    }
    for (const Candidate& one : found) add(one);
  }
  return all;
}

std::size_t count_of(const std::vector<document::Problem>& list, const std::string& path) {
  const auto of_file = [&](const document::Problem& problem) { return problem.file == path; };
  return static_cast<std::size_t>(std::count_if(list.begin(), list.end(), of_file));
}

}  // namespace

std::string_view name_of(FileKind kind) noexcept {
  static constexpr auto names = enum_names<FileKind>({{FileKind::unknown, "unknown"},
                                                      {FileKind::rig, "rig"},
                                                      {FileKind::board_map, "board map"},
                                                      {FileKind::model, "model"},
                                                      {FileKind::sequence, "sequence"},
                                                      {FileKind::plc, "PLC gateway"},
                                                      {FileKind::web, "page"}});
  return names[kind];
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
  // An incomplete document has a syntax error, which was already reported.
  if (best == FileKind::unknown && document.complete) report_unknown(document, problems);
  return best;
}

CheckReport check_files(std::span<const std::string> paths, std::span<const control::Argument> arguments) {
  CheckReport report;
  document::Problems problems;
  Read read;
  for (const Candidate& candidate : candidates_of(paths, problems)) {
    CheckedFile& file = report.files.emplace_back();
    file.path = candidate.path;
    document::Problems found;
    const document::Document document = document::parse_file(file.path, found);
    const bool parsed = found.empty();
    file.kind = kind_of(document, found);
    file.passed_over = candidate.from_folder && parsed && file.kind == FileKind::unknown;
    if (file.passed_over) continue;
    for (const document::Problem& problem : found.list()) problems.add(problem);
    read_as(document, parsed, arguments, file, problems, read);
  }
  report.has_rig = !read.rigs.empty();
  fit_sequences(read, problems);
  compare(read, problems);
  // A model is read more than once if two rigs refer to its file, or if the file is also an argument. The
  // problems of the model are reported only once.
  report.problems = problems.without_repeats();
  for (CheckedFile& file : report.files) {
    file.errors = count_of(report.problems.list(), file.path);
    file.warnings = count_of(report.problems.warnings(), file.path);
  }
  return report;
}

}  // namespace softgrip::rig
