#include "rig/web_file/settings.h"

#include "base/net/listener.h"
#include "document/schema.h"

namespace softgrip::web {

namespace {

using document::MapReader;
using document::Node;
using document::optional;
using document::required;
using Keys = document::Keys<Settings>;

struct WebKeys {
  Keys file, daemon, listen, access;
};

const WebKeys& web_keys() {
  using S = Settings;
  static const WebKeys keys{
      {required("name", &S::name, {}, "name of this file in messages"),
       optional("recordings", &S::recordings, {}, "folder of the daemon's recordings, which the page shows"),
       {"daemon", "map", "", "sockets of the daemon"},
       {"listen", "map", "", "address of the page"},
       {"access", "map", "", "permissions of clients"}},
      {required("look", &S::look_socket, {},
                "read-only socket of the daemon, from which the page gets all values that it shows"),
       optional("operate", &S::operate_socket, {}, "socket of the daemon for commands")},
      {required("address", &S::address, {}, "numeric IP address of the web server"),
       required("port", &S::port, {0, 65535}, "port of the web server"),
       optional("max_connections", &S::max_connections, {4, 512}, "largest number of connections"),
       {"hosts", "list", "none",
        "host names under which clients may open the page, in addition to `localhost` and numeric "
        "addresses"}},
      {optional("tokens", &S::tokens, {}, "file that contains the tokens"),
       required("without_token", &S::without_token, role_names, "role of a client without a token"),
       optional("session_idle_s", &S::session_idle_s, {1, 86400},
                "time without requests and without an open page after which a session ends"),
       optional("session_s", &S::session_s, {1, 604800}, "time after which every session ends")}};
  return keys;
}

void check_listen(const document::Document& document, MapReader& reader, document::Problems& problems,
                  Settings& settings) {
  if (reader.good("address") && !net::is_numeric(settings.address)) {
    reader.report("address", "this is not a numeric address",
                  "write an IPv4 or IPv6 address in digits, for example 192.168.1.20");
  }
  for (const Node* const item : reader.sequence("hosts", false)) {
    settings.hosts.push_back(item->scalar);
    if (item->kind != Node::Kind::scalar || item->scalar.find_first_of("/: ") != std::string::npos)
      problems.add(document.problem(item->at, "this is not the name of a computer", "gripper.example.org"));
  }
}

void check_access(MapReader& reader, const Settings& settings) {
  // If the address is wrong, check_listen() has already reported the error.
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

std::vector<document::KeyFacts> file_keys() {
  std::vector<document::KeyFacts> facts;
  append_facts(facts, web_keys().file);
  append_facts(facts, web_keys().daemon, "daemon: ");
  append_facts(facts, web_keys().listen, "listen: ");
  append_facts(facts, web_keys().access, "access: ");
  return facts;
}

Settings read_settings(const document::Document& document, document::Problems& problems) {
  Settings settings;
  MapReader top(document, document.root, problems, "the file");
  read_keys(top, web_keys().file, settings);
  read_map(top, "daemon", true, web_keys().daemon, settings);
  read_map(top, "listen", true, web_keys().listen, settings,
           [&](MapReader& reader) { check_listen(document, reader, problems, settings); });
  read_map(top, "access", true, web_keys().access, settings,
           [&](MapReader& reader) { check_access(reader, settings); });
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
