#include "tools/commissioning/examinations.h"

#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "base/descriptor.h"
#include "rig/plc_file/settings.h"
#include "rig/web_file/settings.h"

namespace softgrip::tools::doctor {
namespace {

namespace fs = std::filesystem;

struct Place {
  std::string address;
  std::uint16_t port = 0;
};

bool somebody_listens(const Place& place) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  if (::getaddrinfo(place.address.c_str(), std::to_string(place.port).c_str(), &hints, &found) != 0)
    return false;
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> list(found, &::freeaddrinfo);
  const Descriptor socket{::socket(list->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  // Time-out of the connection. The address belongs to this computer, so a listening program accepts the
  // connection far within 1 s.
  const timeval patience{1, 0};
  return socket && ::setsockopt(socket.get(), SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience) == 0 &&
         ::connect(socket.get(), list->ai_addr, list->ai_addrlen) == 0;
}

template <class Settings>
std::optional<Place> place_of(const std::optional<Settings>& settings) {
  return settings ? std::optional(Place{settings->address, settings->port}) : std::nullopt;
}

void examine(const std::string& program, const std::string& file, const std::optional<Place>& place,
             const document::Problems& problems, Findings& findings) {
  if (!place) {
    findings.warn(program, fmt::format("the service is enabled, but {} cannot be used", file),
                  problems.list().empty() ? "softgrip check " + file : problems.list().front().message);
    return;
  }
  const std::string where = fmt::format("{}:{}", place->address, place->port);
  if (somebody_listens(*place)) {
    findings.ok(program, "listens on " + where);
  } else {
    findings.warn(program, "the service is enabled, but not listening on " + where,
                  fmt::format("systemctl status {}; journalctl -u {}", program, program));
  }
}

}  // namespace

void examine_gateways(const std::string& units, const std::string& configuration, Findings& findings) {
  const auto enabled = [&](const char* program) {
    return fs::is_symlink(fs::path(units) / (std::string(program) + ".service"));
  };
  if (enabled("softgrip-plc")) {
    document::Problems problems;
    const std::string file = configuration + "/plc.yaml";
    const auto place = place_of(plc::load_settings(file, problems));
    examine("softgrip-plc", file, place, problems, findings);
  }
  if (enabled("softgrip-web")) {
    document::Problems problems;
    const std::string file = configuration + "/web.yaml";
    const auto place = place_of(web::load_settings(file, problems));
    examine("softgrip-web", file, place, problems, findings);
  }
}

}  // namespace softgrip::tools::doctor
