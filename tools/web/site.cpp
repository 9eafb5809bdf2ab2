#include "tools/web/site.h"

#include <charconv>
#include <utility>

#include <fmt/format.h>

#include "base/json.h"
#include "tools/web/commander.h"
#include "tools/web/metrics/metrics.h"
#include "tools/web/recordings.h"

namespace softgrip::web {

namespace {

using Json = nlohmann::ordered_json;
using httplib::Request;
using httplib::Response;

constexpr const char* json_type = "application/json";
constexpr const char* disk_timeout_message = "the disk with the recordings does not respond";
/// Content-Security-Policy of the page. The page may load files from this server only, and it may not submit
/// forms. Other sites cannot embed the page in a frame.
constexpr const char* page_policy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
/// Content-Security-Policy of recordings. A recording may contain files of other people, so it may not run
/// scripts and may not load files from other sites.
constexpr const char* recording_policy =
    "default-src 'none'; style-src 'unsafe-inline'; img-src 'self' data:; sandbox; frame-ancestors 'none'";

/// An icon that shows two fingers.
constexpr std::string_view icon =
    R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 16 16"><path fill="none" stroke="#0b57a4" stroke-width="3")"
    R"( stroke-linecap="round" d="M5 2C1 6 2 11 6 14M11 2c4 4 3 9-1 12"/></svg>)";

void put_json(Response& response, const Json& json, int status = 200) {
  response.status = status;
  response.set_content(json_dump(json), json_type);
}

void put_error(Response& response, int status, std::string_view message) {
  put_json(response, {{"error", message}}, status);
}

/// Replaces a header. The old value is removed first, because the library stores headers in a multimap and
/// would send both the old and the new value.
void replace_header(Response& response, const char* name, const char* value) {
  response.headers.erase(name);
  response.set_header(name, value);
}

/// Returns the HTTP status in a line such as "HTTP/1.1 200 OK..."; 0 if the response is empty.
int status_in(std::string_view answer) {
  constexpr std::size_t at = 9;
  int status = 0;
  if (answer.size() > at) std::from_chars(answer.data() + at, answer.data() + answer.size(), status);
  return status;
}

void put_file(Response& response, std::string_view text, const char* type) {
  response.set_content(text.data(), text.size(), type);
}

}  // namespace

std::string_view name_of(Role role) noexcept {
  return role_names[role];
}

Site::Site(const Settings& settings, Gate& gate, const LiveState& state, const ServerCounts& counts,
           std::string chart_js)
    : settings_(settings), gate_(gate), state_(state), counts_(counts), chart_js_(std::move(chart_js)) {
  engine_.set_default_headers({{"Cache-Control", "no-store"},
                               {"Content-Security-Policy", page_policy},
                               {"Cross-Origin-Opener-Policy", "same-origin"},
                               {"Cross-Origin-Resource-Policy", "same-origin"},
                               {"Referrer-Policy", "no-referrer"},
                               {"X-Content-Type-Options", "nosniff"},
                               {"X-Frame-Options", "DENY"}});
  engine_.set_pre_routing_handler([this](const Request& request, Response& response) {
    return reject(request, response) ? httplib::Server::HandlerResponse::Handled
                                     : httplib::Server::HandlerResponse::Unhandled;
  });
  engine_.set_error_handler([](const Request&, Response& response) {
    if (response.body.empty()) put_error(response, response.status, "not found");
  });
  engine_.set_exception_handler([](const Request&, Response& response, const std::exception_ptr&) {
    put_error(response, 500, "the server could not handle the request");
  });
  add_page();
  add_sessions();
  add_data();
  add_recordings();
  add_commands();
}

Outcome Site::serve(std::string_view request, Nanoseconds now, const Reply& reply) {
  now_ = now;
  reply_ = reply;
  role_ = Role::none;
  outcome_ = {};
  outcome_.bytes = engine_.answer(request);
  outcome_.status = status_in(outcome_.bytes);
  outcome_.role = role_;
  if (outcome_.stream_reader) outcome_.bytes += state_.snapshot_message();
  return std::move(outcome_);
}

std::string Site::error_response(int status) {
  return fmt::format("HTTP/1.1 {} Refused\r\nConnection: close\r\nContent-Length: 0\r\n\r\n", status);
}

bool Site::reject(const Request& request, Response& response) {
  credentials_ = {request.get_header_value("Host"), request.get_header_value("Origin"),
                  request.get_header_value("Sec-Fetch-Site"), request.get_header_value("Cookie"),
                  request.get_header_value("Authorization")};
  const bool changes = request.method != "GET" && request.method != "HEAD";
  const auto role = gate_.authorize(credentials_, changes, now_);
  if (!role) {
    put_error(response, role.error().status, role.error().message);
    return true;
  }
  role_ = *role;
  return false;
}

bool Site::require_role(Role role, Response& response) const {
  if (role_ >= role) return true;
  if (role_ == Role::none) {
    response.set_header("WWW-Authenticate", "Bearer");
    put_error(response, 401, "log in with a token first");
  } else {
    put_error(response, 403, "read-only clients may not send this request");
  }
  return false;
}

void Site::add_page() {
  engine_.Get("/", [](const Request&, Response& response) {
    put_file(response, page_html(), "text/html; charset=utf-8");
  });
  engine_.Get("/icon.svg",
              [](const Request&, Response& response) { put_file(response, icon, "image/svg+xml"); });
  engine_.Get("/page.css", [](const Request&, Response& response) {
    put_file(response, page_css(), "text/css; charset=utf-8");
  });
  engine_.Get("/page.js", [](const Request&, Response& response) {
    put_file(response, page_js(), "text/javascript; charset=utf-8");
  });
  engine_.Get("/chart.js", [this](const Request&, Response& response) {
    if (chart_js_.empty()) return put_error(response, 404, "the package libjs-chart.js is not installed");
    replace_header(response, "Cache-Control", "max-age=3600");
    put_file(response, chart_js_, "text/javascript; charset=utf-8");
  });
}

void Site::add_sessions() {
  const auto describe_session = [this](const Request&, Response& response) {
    put_json(response, {{"role", name_of(role_)},
                        {"tokens", gate_.has_tokens()},
                        {"byToken", role_ > settings_.without_token},
                        {"commands", !settings_.operate_socket.empty()}});
  };
  engine_.Get("/api/session", describe_session);
  engine_.Post("/api/session", [this](const Request& request, Response& response) {
    const Json body = Json::parse(request.body, nullptr, false);
    if (!body.is_object() || !body.contains("token") || !body["token"].is_string())
      return put_error(response, 400, "the body must be {\"token\": \"...\"}");
    const auto session = gate_.open(body["token"].get<std::string>(), now_);
    if (!session) return put_error(response, session.error().status, session.error().message);
    response.set_header("Set-Cookie",
                        fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict", session_cookie, *session));
    put_json(response, Json::object());
  });
  engine_.Delete("/api/session", [this](const Request& request, Response& response) {
    gate_.close(request.get_header_value("Cookie"));
    response.set_header("Set-Cookie",
                        fmt::format("{}=; Path=/; HttpOnly; SameSite=Strict; Max-Age=0", session_cookie));
    put_json(response, Json::object());
  });
}

void Site::add_data() {
  engine_.Get("/metrics", [this](const Request&, Response& response) {
    if (!require_role(Role::look, response)) return;
    if (reply_.disk == nullptr && !settings_.recordings.empty()) {
      outcome_.disk_request = DiskRequest{.kind = DiskRequest::Kind::health};
    } else {
      response.set_content(metrics(), "text/plain; version=0.0.4; charset=utf-8");
    }
  });
  engine_.Get("/api/status", [this](const Request&, Response& response) {
    if (!require_role(Role::look, response)) return;
    if (state_.status().is_null()) return put_error(response, 503, "softgripd does not respond");
    put_json(response, state_.status());
  });
  engine_.Get("/api/stream", [this](const Request&, Response& response) { begin_stream(response); });
}

/// Begins a stream of messages. The library writes the head of the response, which contains no length. The
/// owner of the connection adds the messages.
void Site::begin_stream(Response& response) {
  if (!require_role(Role::look, response)) return;
  outcome_.stream_reader = StreamReader{credentials_, role_};
  response.set_content_provider("text/event-stream", [](std::size_t, httplib::DataSink&) { return false; });
}

std::string Site::metrics() const {
  MetricText metrics;
  add_daemon_metrics(state_.status(), state_.statistics(), metrics);
  add_health_metrics(state_.health(), metrics);
  using enum MetricText::Type;
  metrics.family("softgrip_web_connections", gauge,
                 "Number of open connections of browsers and metrics collectors.");
  metrics.sample(static_cast<double>(counts_.connections));
  metrics.family("softgrip_web_pages", gauge, "Open pages.");
  metrics.sample(static_cast<double>(counts_.streams));
  metrics.family("softgrip_web_unsent_bytes", gauge,
                 "Number of bytes that wait in softgrip-web until they can be sent to clients.");
  metrics.sample(static_cast<double>(counts_.unsent));
  metrics.family("softgrip_web_turned_away_total", counter,
                 "Number of connections that were refused or closed because a limit was reached.");
  metrics.sample(static_cast<double>(counts_.rejected));
  metrics.family("softgrip_web_answers_total", counter, "HTTP responses, by status.");
  for (const auto& [status, count] : counts_.responses)
    metrics.sample({{"status", std::to_string(status)}}, static_cast<double>(count));
  return metrics.text();
}

void Site::add_recordings() {
  engine_.Get("/api/recordings", [this](const Request&, Response& response) { list(response); });
  engine_.Get(R"(/recordings/([A-Za-z0-9._-]+)/([A-Za-z0-9._-]+))",
              [this](const Request& request, Response& response) { show(request, response); });
}

void Site::list(Response& response) {
  if (!require_role(Role::look, response)) return;
  if (reply_.disk == nullptr) {
    outcome_.disk_request = DiskRequest{.kind = DiskRequest::Kind::listing};
  } else if (!reply_.disk->done()) {
    put_error(response, 503, disk_timeout_message);
  } else {
    response.set_content(reply_.disk->text(), json_type);
  }
}

/// Begins the response with a file. The library writes the head of the response. The content of the file is
/// sent in pieces and is never in memory completely.
void Site::show(const Request& request, Response& response) {
  if (!require_role(Role::look, response)) return;
  const std::string name = request.matches[2];
  if (reply_.disk == nullptr) {
    outcome_.disk_request =
        DiskRequest{.kind = DiskRequest::Kind::file, .recording = request.matches[1], .name = name};
    return;
  }
  if (!reply_.disk->done()) return put_error(response, 503, disk_timeout_message);
  const auto& file = reply_.disk->file();
  if (!file)
    return put_error(
        response, 404,
        fmt::format("the file does not exist, is larger than {} MiB, or has a kind that cannot be "
                    "shown",
                    Recordings::largest_file >> 20U));
  replace_header(response, "Content-Security-Policy", recording_policy);
  const std::string type(content_type_of(name));
  if (file->size == 0) return response.set_content("", type);
  response.set_content_provider(file->size, type,
                                [](std::size_t, std::size_t, httplib::DataSink&) { return false; });
  if (request.method == "GET") outcome_.file = file;
}

void Site::add_commands() {
  engine_.Post("/api/command",
               [this](const Request& request, Response& response) { command(request, response); });
}

void Site::command(const Request& request, Response& response) {
  if (!require_role(Role::operate, response)) return;
  if (!request.get_header_value("Content-Type").starts_with(json_type))
    return put_error(response, 415, "the Content-Type must be application/json");
  auto command = command_in(request.body);
  if (!command) return put_error(response, 400, command.error());
  if (reply_.daemon == nullptr) {
    outcome_.command = std::move(*command);
    return;
  }
  const Json& answer = *reply_.daemon;
  if (answer.value("ok", false)) return put_json(response, answer.value("result", Json::object()));
  const Json& error = answer.contains("error") ? answer["error"] : answer;
  const std::string code = error.value("code", "");
  const bool unreachable = code == "no_daemon" || code == "no_answer";
  put_json(response, {{"error", error.value("message", "")}, {"code", code}, {"details", error}},
           unreachable ? 503 : 409);
}

}  // namespace softgrip::web
