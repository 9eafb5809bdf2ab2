#include "rig/rig_file.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "base/text.h"
#include "model/file/model_file.h"
#include "rig/rig_file_reader.h"

namespace softgrip::rig {

namespace {

/// Searches the folder of `path` for the file name that is most similar to the file name of `path`. Returns
/// `named` with this file name; "" if no name is similar.
std::string nearest_file(const std::string& named, const std::string& path) {
  const std::filesystem::path wanted(path);
  std::error_code error;
  std::vector<std::string> names;
  const std::filesystem::path folder = wanted.has_parent_path() ? wanted.parent_path() : ".";
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  const std::string near = document::nearest(wanted.filename().string(), names);
  return near.empty() ? std::string{} : std::filesystem::path(named).replace_filename(near).string();
}

/// Returns the error number (errno) that reading the file would cause; 0 if the file is readable.
int reading_error(const std::string& path) {
  if (::access(path.c_str(), R_OK) != 0) return errno;
  std::error_code error;
  return std::filesystem::is_directory(path, error) ? EISDIR : 0;
}

/// Returns the text of a stored file; null if the file `path` is not among the stored files.
const std::string* stored_text(const std::vector<InputFile>& stored, const std::string& path) {
  const auto found =
      std::find_if(stored.begin(), stored.end(), [&](const InputFile& file) { return file.path == path; });
  return found != stored.end() ? &found->text : nullptr;
}

void remember(Context& context, InputFile::Role role, const document::Document& document) {
  const auto same = [&](const InputFile& input) { return input.path == document.file; };
  std::vector<InputFile>& inputs = context.rig.inputs;
  if (std::none_of(inputs.begin(), inputs.end(), same)) {
    inputs.push_back({role, document.file, document.text});
  }
}

struct BoardKind {
  const char* key;
  void (*read)(Context& context, const document::Node& node);
  bool after_channels;  ///< true: the board is read after the channels; false: before the channels
};
constexpr std::array board_kinds{
    BoardKind{"simulated", read_simulated_board, true},
    BoardKind{"modbus_tcp", read_modbus_tcp, false},
    BoardKind{"modbus_rtu", read_modbus_rtu, false},
    BoardKind{"iio", read_iio, false},
};

void read_board_and_channels(Context& context, MapReader& top) {
  const document::Node* const board = top.child("board", true);
  const BoardKind* kind = nullptr;
  const document::Node* node = nullptr;
  if (board != nullptr) {
    MapReader reader(context.document, *board, context.problems, "board");
    std::size_t found = 0;
    for (const BoardKind& one : board_kinds) {
      const document::Node* const child = reader.child(one.key, false);
      if (child == nullptr) continue;
      ++found;
      kind = &one;
      node = child;
    }
    const bool is_map = board->kind == document::Node::Kind::map;
    if (is_map && found != 1 && reader.keys().size() != 1) {
      top.report("board",
                 "board must hold one of " + enumerated(board_kinds, " and ", [](const BoardKind& one) {
                   return document::in_backticks(one.key);
                 }));
    }
  }
  if (kind != nullptr) context.board_key = kind->key;
  const auto read_board = [&] {
    if (kind == nullptr) return;
    const std::size_t before = context.problems.size();
    kind->read(context, *node);
    context.sound.board = top.good("board") && context.problems.size() == before;
  };
  if (kind != nullptr && !kind->after_channels) read_board();
  const std::size_t before = context.problems.size();
  read_channels(context, top);
  context.sound.channels = top.good("channels") && context.problems.size() == before;
  if (kind != nullptr && kind->after_channels) read_board();
}

/// Reads a map of the rig file with the function `read`. Returns true if the map is present and has no error.
bool reads_well(Context& context, MapReader& top, std::string_view key,
                void (*read)(Context& context, MapReader& top)) {
  const std::size_t before = context.problems.size();
  read(context, top);
  return top.good(key) && context.problems.size() == before;
}

/// Returns true if all channels have names, because sequences refer to channels by name.
bool all_named(const Context& context) {
  const auto& channels = context.rig.settings.channels;
  return !channels.empty() && context.names.size() == channels.size();
}

}  // namespace

std::string resolved(const Context& context, const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(context.document.file).parent_path();
  return (folder / path).lexically_normal().string();
}

std::optional<document::Document> named_document(Context& context, MapReader& reader, std::string_view key,
                                                 InputFile::Role role) {
  const std::string named = reader.text(key);
  if (named.empty()) return std::nullopt;
  const std::string path = resolved(context, named);
  const std::string* const text = context.stored != nullptr ? stored_text(*context.stored, path) : nullptr;
  const int unstored = context.stored != nullptr ? ENOENT : reading_error(path);
  if (const int error = text != nullptr ? 0 : unstored; error != 0) {
    const std::string near = error == ENOENT ? nearest_file(named, path) : std::string{};
    reader.report(key,
                  "`" + std::string(key) + "` names `" + document::shown(path, 200) +
                      "`, which cannot be read: " + std::strerror(error),
                  near.empty() ? "paths are relative to the folder of the rig file"
                               : "did you mean `" + document::shown(near, 200) + "`?");
    return std::nullopt;
  }
  document::Document document = text != nullptr ? document::parse(path, *text, context.problems)
                                                : document::parse_file(path, context.problems);
  remember(context, role, document);
  return document;
}

std::optional<model::Model> named_model(Context& context, MapReader& reader, std::string_view key,
                                        InputFile::Role role) {
  const std::optional<std::string> named = reader.optional_text(key);
  if (named && !named->empty()) {
    const auto known = context.models.find(resolved(context, *named));
    if (known != context.models.end()) return known->second;
  }
  const std::size_t problems = context.problems.size();
  const auto document = named_document(context, reader, key, role);
  if (!document) return std::nullopt;
  std::optional<model::Model> model = model::read_rig_model(*document, context.problems);
  if (context.problems.size() != problems) model.reset();
  context.models.emplace(document->file, model);
  return model;
}

std::string read_name(MapReader& reader, std::string_view key) {
  constexpr std::size_t longest = 32;
  std::string name = reader.text(key);
  const auto good = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  };
  if (!std::all_of(name.begin(), name.end(), good) || name.size() > longest) {
    reader.report(key, "`" + std::string(key) + "` must be at most " + std::to_string(longest) +
                           " letters, digits, `-` or `_`, found `" + document::shown(name) + "`");
  }
  return name;
}

void report_repeated(MapReader& reader, std::string_view key, const std::string& what,
                     document::Location first) {
  reader.report(key, what + " is already used at " + text_of(first));
}

namespace {

RigReading read_with(const std::vector<InputFile>* stored, const document::Document& document,
                     document::Problems& problems) {
  const std::size_t before = problems.size();
  RigReading reading;
  RigFile& rig = reading.rig;
  rig.path = document.file;
  rig.inputs.push_back({InputFile::Role::rig, document.file, document.text});
  Context context{document, problems, rig, {}, {}, {}, {}, {}, {}, {}, {}, false, {}, {}, stored};
  Context::Sound& sound = context.sound;
  MapReader top(document, document.root, problems, "the rig");
  read_keys(top, rig_keys().rig, rig.settings);
  rig.name = read_name(top, "name");
  context.rate_known = top.good("rate_hz");
  sound.loop = reads_well(context, top, "loop", read_loop) || !top.has("loop");
  sound.faults = reads_well(context, top, "faults", read_faults);
  read_board_and_channels(context, top);
  sound.safety = reads_well(context, top, "safety", read_safety);
  sound.detection = reads_well(context, top, "detection", read_detection);
  sound.rest = reads_well(context, top, "rest", read_rest);
  read_real_time(context, top);
  read_recorder(context, top);
  read_socket(context, top);
  read_gpio(context, top);
  top.finish();
  if (document.complete) check_whole(context, top);
  reading.accepted = problems.size() == before && document.complete;
  reading.fits_sequences =
      document.complete && context.rate_known && sound.detection && sound.rest && all_named(context);
  reading.motion_known = context.motion_known;
  return reading;
}

}  // namespace

RigReading read_rig_so_far(const document::Document& document, document::Problems& problems) {
  return read_with(nullptr, document, problems);
}

std::optional<RigFile> read_stored_rig(const std::vector<InputFile>& inputs, document::Problems& problems) {
  if (inputs.empty()) return std::nullopt;
  const std::size_t before = problems.size();
  const document::Document document = document::parse(inputs.front().path, inputs.front().text, problems);
  RigReading reading = read_with(&inputs, document, problems);
  if (problems.size() != before || !reading.accepted) return std::nullopt;
  return std::move(reading.rig);
}

std::optional<RigFile> read_rig(const document::Document& document, document::Problems& problems) {
  RigReading reading = read_rig_so_far(document, problems);
  if (!reading.accepted) return std::nullopt;
  return std::move(reading.rig);
}

std::optional<RigFile> load_rig(const std::string& path, document::Problems& problems) {
  const std::size_t before = problems.size();
  const document::Document document = document::parse_file(path, problems);
  std::optional<RigFile> rig = read_rig(document, problems);
  if (problems.size() != before) return std::nullopt;
  return rig;
}

namespace {

using document::Node;

const Node* value_of(const Node* map, std::string_view key) {
  if (map == nullptr) return nullptr;
  const auto found = std::find_if(map->entries.begin(), map->entries.end(),
                                  [key](const Node::Entry& entry) { return entry.key == key; });
  return found == map->entries.end() ? nullptr : &found->value;
}

}  // namespace

std::optional<std::string> socket_path_of(const std::string& rig_path, document::Problems& problems) {
  document::Problems ignored;  // problems in the other parts of the file are not reported
  const document::Document document = document::parse_file(rig_path, ignored);
  const Node* const path = value_of(value_of(&document.root, "socket"), "path");
  if (path != nullptr && path->kind == Node::Kind::scalar && !path->scalar.empty()) {
    return (std::filesystem::path(rig_path).parent_path() / path->scalar).lexically_normal().string();
  }
  for (const document::Problem& problem : ignored.list()) problems.add(problem);
  if (ignored.empty()) {
    problems.add(
        document.problem(document.root.at, "this file does not name a socket",
                         "write `socket: {path: ...}` in the rig file, or give the socket with --socket"));
  }
  return std::nullopt;
}

}  // namespace softgrip::rig
