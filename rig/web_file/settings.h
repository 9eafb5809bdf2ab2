#pragma once
// What softgrip-web must know: config/web.yaml as plain values. docs/how-to/operator-page.md describes it.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "document/node.h"
#include "document/problem.h"

namespace softgrip::web {

/// What somebody may do, in growing order.
enum class Role : std::uint8_t { none, look, operate };

struct Settings {
  std::string name;
  std::string look_socket;     ///< of softgripd: what is shown comes from it
  std::string operate_socket;  ///< what is commanded goes to it; empty: nothing can be
  std::string address;         ///< numeric
  std::uint16_t port = 0;
  std::size_t max_connections = 64;
  std::vector<std::string> hosts;  ///< names besides `localhost` under which a browser may reach the page
  std::string tokens;              ///< path of the tokens' file; empty: there are none
  Role without_token = Role::look;
  double session_idle_s = 1800;  ///< a session without requests and without an open page ends
  double session_s = 43200;      ///< any session ends
  std::string recordings;        ///< folder of the daemon's recordings; empty: they are not shown
};

/// Reads a document, adding its problems.
[[nodiscard]] Settings read_settings(const document::Document& document, document::Problems& problems);
/// Reads the file; nothing if there are problems, which are all added.
[[nodiscard]] std::optional<Settings> load_settings(const std::string& path, document::Problems& problems);

}  // namespace softgrip::web
