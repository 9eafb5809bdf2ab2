#include "rig/rig_file.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "model/file/model_file.h"
#include "rig/rig_file_reader.h"

namespace softgrip::rig {

namespace {

/// The file in the same folder whose name is nearest to a path that does not exist.
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

/// Why a file cannot be read, as errno; 0: it can.
int reading_error(const std::string& path) {
  if (::access(path.c_str(), R_OK) != 0) return errno;
  std::error_code error;
  return std::filesystem::is_directory(path, error) ? EISDIR : 0;
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
  bool after_channels;  ///< the simulated one needs them; of the others they need the terminals
};
constexpr std::array<BoardKind, 4> board_kinds{
    BoardKind{"simulated", read_simulated_board, true}, BoardKind{"modbus_tcp", read_modbus_tcp, false},
    BoardKind{"modbus_rtu", read_modbus_rtu, false}, BoardKind{"iio", read_iio, false}};

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
      top.report("board", "board must hold one of `simulated`, `modbus_tcp`, `modbus_rtu` and `iio`");
    }
  }
  if (kind != nullptr) context.board_key = kind->key;
  if (kind != nullptr && !kind->after_channels) kind->read(context, *node);
  read_channels(context, top);
  if (kind != nullptr && kind->after_channels) kind->read(context, *node);
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
  if (const int error = reading_error(path); error != 0) {
    const std::string near = error == ENOENT ? nearest_file(named, path) : std::string{};
    reader.report(key,
                  "`" + std::string(key) + "` names `" + document::shown(path, 200) +
                      "`, which cannot be read: " + std::strerror(error),
                  near.empty() ? "paths are relative to the folder of the rig file"
                               : "did you mean `" + document::shown(near, 200) + "`?");
    return std::nullopt;
  }
  document::Document document = document::parse_file(path, context.problems);
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
  std::optional<model::Model> model = model::read_model(*document, context.problems);
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

std::string place(document::Location at) {
  return std::to_string(at.line) + ":" + std::to_string(at.column);
}

void report_repeated(MapReader& reader, std::string_view key, const std::string& what,
                     document::Location first) {
  reader.report(key, what + " is already used at " + place(first));
}

std::optional<RigFile> read_rig(const document::Document& document, document::Problems& problems) {
  const std::size_t before = problems.size();
  RigFile rig;
  rig.path = document.file;
  rig.inputs.push_back({InputFile::Role::rig, document.file, document.text});
  Context context{document, problems, rig, {}, {}, {}, {}, {}, {}, {}};
  MapReader top(document, document.root, problems, "the rig");
  rig.name = read_name(top, "name");
  rig.settings.rate_hz = top.number("rate_hz", {1, 10'000});
  context.rate_known = top.good("rate_hz");
  read_loop(context, top);
  read_faults(context, top);
  read_board_and_channels(context, top);
  read_safety(context, top);
  read_detection(context, top);
  read_rest(context, top);
  read_real_time(context, top);
  read_recorder(context, top);
  read_socket(context, top);
  read_gpio(context, top);
  top.finish();
  if (problems.size() == before && document.complete) check_whole(context, top);
  if (problems.size() != before || !document.complete) return std::nullopt;
  return rig;
}

std::optional<RigFile> load_rig(const std::string& path, document::Problems& problems) {
  const std::size_t before = problems.size();
  const document::Document document = document::parse_file(path, problems);
  std::optional<RigFile> rig = read_rig(document, problems);
  if (problems.size() != before) return std::nullopt;
  return rig;
}

}  // namespace softgrip::rig
