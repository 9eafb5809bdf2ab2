#include "rig/socket_path.h"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "document/node.h"

namespace softgrip::rig {

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
