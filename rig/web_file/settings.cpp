#include "rig/web_file/settings.h"

#include "base/net/listener.h"
#include "document/reader.h"

namespace softgrip::web {

namespace {

using document::MapReader;
using document::Node;

void read_daemon(const document::Document& document, const Node& node, document::Problems& problems,
                 Settings& settings) {
  MapReader reader(document, node, problems, "daemon");
  settings.look_socket = reader.text("look");
  settings.operate_socket = reader.optional_text("operate").value_or("");
}

void read_listen(const document::Document& document, const Node& node, document::Problems& problems,
                 Settings& settings) {
  MapReader reader(document, node, problems, "listen");
  settings.address = reader.text("address");
  if (reader.good("address") && !net::is_numeric(settings.address)) {
    reader.report("address", "this is not a numeric address",
                  "write an IPv4 or IPv6 address in digits, for example 192.168.1.20");
  }
  settings.port = static_cast<std::uint16_t>(reader.integer("port", 0, 65535));
  settings.max_connections =
      static_cast<std::size_t>(reader.optional_integer("max_connections", 4, 512).value_or(64));
  for (const Node* const item : reader.sequence("hosts", false)) {
    settings.hosts.push_back(item->scalar);
    if (item->kind != Node::Kind::scalar || item->scalar.find_first_of("/: ") != std::string::npos)
      problems.add(document.problem(item->at, "this is not the name of a computer", "gripper.example.org"));
  }
}

void read_access(const document::Document& document, const Node& node, document::Problems& problems,
                 Settings& settings) {
  MapReader reader(document, node, problems, "access");
  settings.tokens = reader.optional_text("tokens").value_or("");
  settings.without_token = static_cast<Role>(reader.choice("without_token", {"none", "look", "operate"}));
  settings.session_idle_s = reader.optional_number("session_idle_s", {1, 86400}).value_or(1800);
  settings.session_s = reader.optional_number("session_s", {1, 604800}).value_or(43200);
  // read_listen() has already reported a wrong address.
  if (!net::is_numeric(settings.address) || net::is_loopback(settings.address)) return;
  if (reader.good("without_token") && settings.without_token != Role::none) {
    reader.report("without_token", "other machines can reach this address, so each client needs a token",
                  "without_token: none");
  }
  if (settings.tokens.empty())
    reader.report(
        "tokens",
        "other machines can reach this address, so `tokens` must name a file with the tokens of the clients",
        "tokens: /etc/softgrip/web.tokens");
}

}  // namespace

Settings read_settings(const document::Document& document, document::Problems& problems) {
  Settings settings;
  MapReader top(document, document.root, problems, "the file");
  settings.name = top.text("name");
  settings.recordings = top.optional_text("recordings").value_or("");
  if (const Node* const node = top.child("daemon", true)) read_daemon(document, *node, problems, settings);
  if (const Node* const node = top.child("listen", true)) read_listen(document, *node, problems, settings);
  if (const Node* const node = top.child("access", true)) read_access(document, *node, problems, settings);
  return settings;
}

std::optional<Settings> load_settings(const std::string& path, document::Problems& problems) {
  const document::Document document = document::parse_file(path, problems);
  if (!problems.empty()) return std::nullopt;
  Settings settings = read_settings(document, problems);
  if (!problems.empty()) return std::nullopt;
  return settings;
}

}  // namespace softgrip::web
