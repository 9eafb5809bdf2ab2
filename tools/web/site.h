#pragma once
// What there is to be asked for, and what is answered. No sockets of browsers.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "base/time.h"
#include "rig/web_file/settings.h"
#include "tools/web/access/gate.h"
#include "tools/web/archive.h"
#include "tools/web/http_engine.h"
#include "tools/web/live_state.h"

namespace softgrip::web {

/// What the program counts of itself.
struct OwnCounts {
  std::size_t connections = 0;
  std::size_t followers = 0;             ///< of them, open pages
  std::size_t unsent = 0;                ///< bytes that wait for their readers
  std::uint64_t turned_away = 0;         ///< connections for which there was no place
  std::map<int, std::uint64_t> answers;  ///< by status
};

/// Who reads a stream of messages.
struct Follower {
  Credentials credentials;
  Role role = Role::none;
};

/// What becomes of a request.
struct Outcome {
  std::string bytes;  ///< for the client
  int status = 0;
  Role role = Role::none;  ///< what the client may do
  /// The bytes begin a stream of messages that goes on, as long as its reader may do what he might at first.
  std::optional<Follower> follower;
  /// The bytes are followed by this file.
  std::shared_ptr<const RegularFile> file;
  /// This is to be asked of the daemon, and the request is to be served again with its answer.
  std::optional<nlohmann::ordered_json> command;
  /// This is to be asked of the disk, and the request is to be served again with its answer.
  std::optional<DiskRequest> disk_request;
};

/// The answer to what an earlier outcome asked for: one of both.
struct Reply {
  const nlohmann::ordered_json* daemon = nullptr;
  const DiskTask* disk = nullptr;  ///< not done: it was given up
};

class Site {
 public:
  /// References outlive it. `chart_js`: the library that draws curves; empty where it is not installed.
  Site(const Settings& settings, Gate& gate, const LiveState& state, const OwnCounts& counts,
       std::string chart_js);

  /// `request`: a complete one, as frame_of() says.
  [[nodiscard]] Outcome serve(std::string_view request, Nanoseconds now, const Reply& reply = {});
  /// The answer to what frame_of() refused, and to whom there is no place.
  [[nodiscard]] static std::string refusal(int status);

 private:
  void add_page();
  void add_sessions();
  void add_data();
  void add_recordings();
  void add_commands();
  /// Runs for everything that is asked for; true: it is answered already.
  bool turn_away(const httplib::Request& request, httplib::Response& response);
  /// True: the sender may do that; otherwise that is answered.
  bool need(Role role, httplib::Response& response) const;
  void greet(httplib::Response& response);
  void command(const httplib::Request& request, httplib::Response& response);
  void list(httplib::Response& response);
  void show(const httplib::Request& request, httplib::Response& response);
  [[nodiscard]] std::string metrics() const;

  const Settings& settings_;
  Gate& gate_;
  const LiveState& state_;
  const OwnCounts& counts_;
  std::string chart_js_;
  HttpEngine engine_;
  // Of the request that is served.
  Nanoseconds now_ = 0;
  Reply reply_;
  Credentials credentials_;
  Role role_ = Role::none;
  Outcome outcome_;
};

/// "none", "look", "operate"
[[nodiscard]] std::string_view name_of(Role role) noexcept;

}  // namespace softgrip::web
