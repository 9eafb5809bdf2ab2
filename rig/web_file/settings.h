#pragma once
// Settings of softgrip-web: config/web.yaml as plain values. docs/how-to/operator-page.md describes the file.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "document/node.h"
#include "document/problem.h"

namespace softgrip::web {

/// Permissions of a client in increasing order.
enum class Role : std::uint8_t { none, look, operate };

struct Settings {
  std::string name;
  std::string look_socket;     ///< socket of softgripd from which the page reads
  std::string operate_socket;  ///< socket for commands; empty: the page has no commands
  std::string address;         ///< numeric IP address at which the page is served
  std::uint16_t port = 0;
  std::size_t max_connections = 64;
  std::vector<std::string> hosts;  ///< host names of the page in addition to `localhost`
  std::string tokens;              ///< path of the file of tokens; empty: no tokens
  Role without_token = Role::look;
  double session_idle_s = 1800;  ///< time after which a session without requests and open page ends [s]
  double session_s = 43200;      ///< time after which each session ends [s]
  std::string recordings;        ///< folder of the daemon's recordings; empty: the page shows none
};

/// Reads a document and adds its problems to `problems`.
[[nodiscard]] Settings read_settings(const document::Document& document, document::Problems& problems);
/// Reads the file and adds all its problems to `problems`. Returns nothing if there is a problem.
[[nodiscard]] std::optional<Settings> load_settings(const std::string& path, document::Problems& problems);

}  // namespace softgrip::web
