#pragma once
// Creates the responses to HTTP requests. Does not use the sockets of the clients.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <httplib.h>
#include <nlohmann/json.hpp>

#include "base/time.h"
#include "rig/web_file/settings.h"
#include "tools/web/access/gate.h"
#include "tools/web/archive.h"
#include "tools/web/live_state.h"

namespace softgrip::web {

/// Uses cpp-httplib as a function that converts the bytes of a request to the bytes of its response. The
/// sockets and threads of cpp-httplib are not used, so a slow client occupies no thread and delays no other
/// client.
class HttpEngine : public httplib::Server {
 public:
  /// Returns the response to a complete request. Throws no exception for any bytes that a client sends.
  [[nodiscard]] std::string answer(std::string_view request);
};

/// Counters of the program softgrip-web. Its metrics contain these counters.
struct ServerCounts {
  std::size_t connections = 0;
  std::size_t streams = 0;                 ///< number of connections that belong to open pages
  std::size_t unsent = 0;                  ///< number of bytes that wait to be sent
  std::uint64_t rejected = 0;              ///< number of connections that were closed or refused because a
                                           ///< limit was reached
  std::map<int, std::uint64_t> responses;  ///< number of responses, by HTTP status
};

/// A client that reads a stream of messages.
struct StreamReader {
  Credentials credentials;
  Role role = Role::none;
};

/// The result of processing an HTTP request.
struct Outcome {
  std::string bytes;  ///< bytes to send to the client
  int status = 0;
  Role role = Role::none;  ///< role of the client that sent the request
  /// Set if the bytes begin a stream of messages. The stream continues while its reader has the role that it
  /// had when the stream began.
  std::optional<StreamReader> stream_reader;
  /// Set if the content of this file must be sent after `bytes`.
  std::shared_ptr<const RegularFile> file;
  /// Set if this command must be sent to the daemon before there is a response to the client. After the
  /// daemon's response, serve() must be called once more.
  std::optional<nlohmann::ordered_json> command;
  /// Set if this request must be sent to the disk before there is a response to the client. After the result
  /// of the disk, serve() must be called once more.
  std::optional<DiskRequest> disk_request;
};

/// The response to a command or to a disk request that an earlier call of serve() has returned.
struct Reply {
  const nlohmann::ordered_json* daemon = nullptr;
  const DiskTask* disk = nullptr;  ///< result of the disk; if it is not done, the time limit for the disk was
                                   ///< exceeded
};

class Site {
 public:
  /// Creates the site. All references must outlive the site. `chart_js` is the text of the library that draws
  /// curves; empty if the library is not installed.
  Site(const Settings& settings, Gate& gate, const LiveState& state, const ServerCounts& counts,
       std::string chart_js);

  /// Returns the result of processing a request. `request` must be complete according to frame_of().
  [[nodiscard]] Outcome serve(std::string_view request, Nanoseconds now, const Reply& reply = {});
  /// Returns the refusal for a request that frame_of() refused, or for a client for which there is no free
  /// connection.
  [[nodiscard]] static std::string error_response(int status);

 private:
  void add_page();
  void add_sessions();
  void add_data();
  void add_recordings();
  void add_commands();
  /// Checks the sender of a request before its handler is called. If the request is refused, writes the
  /// refusal into `response` and returns true.
  bool reject(const httplib::Request& request, httplib::Response& response);
  /// Returns true if the sender has at least the role `role`. Otherwise writes the refusal into `response`.
  bool require_role(Role role, httplib::Response& response) const;
  void begin_stream(httplib::Response& response);
  void command(const httplib::Request& request, httplib::Response& response);
  void list(httplib::Response& response);
  void show(const httplib::Request& request, httplib::Response& response);
  [[nodiscard]] std::string metrics() const;

  const Settings& settings_;
  Gate& gate_;
  const LiveState& state_;
  const ServerCounts& counts_;
  std::string chart_js_;
  HttpEngine engine_;
  // Time at which the current request was received.
  Nanoseconds now_ = 0;
  Reply reply_;
  Credentials credentials_;
  Role role_ = Role::none;
  Outcome outcome_;
};

/// Returns the name of the role: "none", "look" or "operate".
[[nodiscard]] std::string_view name_of(Role role) noexcept;

/// The files of the page. They are compiled into the program, so that a path in a browser's request never
/// selects a file on the disk.
[[nodiscard]] std::string_view page_html() noexcept;
[[nodiscard]] std::string_view page_css() noexcept;
[[nodiscard]] std::string_view page_js() noexcept;

}  // namespace softgrip::web
