#pragma once
// The settings of softgrip-web: config/web.yaml as plain values. docs/how-to/operator-page.md describes the
// file.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/enum_table.h"
#include "document/node.h"
#include "document/problem.h"

namespace softgrip::document {
struct KeyFacts;
}

namespace softgrip::web {

/// Permissions of a client, in increasing order.
enum class Role : std::uint8_t { none, look, operate };
inline constexpr auto role_names =
    enum_names<Role>({{Role::none, "none"}, {Role::look, "look"}, {Role::operate, "operate"}});

/// The contents of the file. file_keys() describes the members.
struct Settings {
  std::string name;
  std::string look_socket;
  std::string operate_socket;
  std::string address;
  std::uint16_t port = 0;
  std::size_t max_connections = 64;
  std::vector<std::string> hosts;
  std::string tokens;
  Role without_token = Role::look;
  double session_idle_s = 1800;
  double session_s = 43200;
  std::string recordings;
};

/// Returns all keys of the settings file. The name of a key begins with the map that contains it: "listen:
/// port".
[[nodiscard]] std::vector<document::KeyFacts> file_keys();
/// Reads the settings from a document, and adds problems of the document to `problems`.
[[nodiscard]] Settings read_settings(const document::Document& document, document::Problems& problems);
/// Reads the settings from a file. Adds all problems of the file to `problems`, and returns nothing if there
/// are any problems.
[[nodiscard]] std::optional<Settings> load_settings(const std::string& path, document::Problems& problems);

}  // namespace softgrip::web
