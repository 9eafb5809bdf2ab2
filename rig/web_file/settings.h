#pragma once
// The settings of softgrip-web: config/web.yaml as plain values. docs/how-to/operator-page.md describes the
// file.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "document/node.h"
#include "document/problem.h"

namespace softgrip::web {

/// Permissions of a client, in increasing order.
enum class Role : std::uint8_t { none, look, operate };

struct Settings {
  std::string name;
  std::string look_socket;     ///< path of softgripd's socket from which the page reads
  std::string operate_socket;  ///< path of softgripd's socket for commands; empty: the page has no commands
  std::string address;         ///< numeric IP address on which the page is served
  std::uint16_t port = 0;
  std::size_t max_connections = 64;
  std::vector<std::string> hosts;  ///< host names of the page, in addition to `localhost`
  std::string tokens;              ///< path of the file that contains the tokens; empty: there are no tokens
  Role without_token = Role::look;
  double session_idle_s = 1800;  ///< a session ends after this time without a request and without an open
                                 ///< page [s]
  double session_s = 43200;      ///< every session of the page ends after this time [s]
  std::string recordings;        ///< folder of the daemon's recordings; empty: the page shows no recordings
};

/// Reads the settings from a document, and adds problems of the document to `problems`.
[[nodiscard]] Settings read_settings(const document::Document& document, document::Problems& problems);
/// Reads the settings from a file. Adds all problems of the file to `problems`, and returns nothing if there
/// are any.
[[nodiscard]] std::optional<Settings> load_settings(const std::string& path, document::Problems& problems);

}  // namespace softgrip::web
