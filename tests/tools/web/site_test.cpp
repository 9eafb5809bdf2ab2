// Tests the class Site. For each request, checks the response that Site returns.

#include "tools/web/site.h"
#include "base/files.h"

#include <gtest/gtest.h>
#include <poll.h>

#include <filesystem>
#include <fstream>

namespace softgrip::web::site_test {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

const std::string look(24, 'a');
const std::string operate(24, 'b');

class SiteTest : public ::testing::Test {
 protected:
  SiteTest() {
    fs::create_directories(folder_ / "run-1");
    std::ofstream(folder_ / "run-1" / "picture.svg") << "<svg/>";
    std::ofstream(folder_ / "run-1" / "secret.txt") << "secret";
    std::ofstream(folder_ / "outside.svg") << "secret";
    fs::create_symlink(folder_ / "outside.svg", folder_ / "run-1" / "link.svg");
  }

  Outcome get(const std::string& path, const std::string& token = {}) { return ask("GET", path, token); }
  Outcome ask(const std::string& method, const std::string& path, const std::string& token,
              const std::string& body = {}, const Json* answer = nullptr) {
    std::string request = method + " " + path + " HTTP/1.1\r\nHost: localhost:1\r\n";
    if (!token.empty()) request += "Authorization: Bearer " + token + "\r\n";
    if (!body.empty()) {
      request += "Content-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) + "\r\n";
    }
    request += "\r\n" + body;
    Outcome outcome = site_.serve(request, 0, {.daemon = answer});
    if (!outcome.disk_request) return outcome;
    const auto task = archive_.submit(*outcome.disk_request);
    wait_for(*task);
    outcome = site_.serve(request, 0, {.disk = task.get()});
    if (outcome.file) outcome.bytes += all_of(outcome.file);
    return outcome;
  }
  void wait_for(const DiskTask& task) {
    pollfd watched{archive_.descriptor(), POLLIN, 0};
    while (!task.done()) {
      ASSERT_EQ(::poll(&watched, 1, 30'000), 1);
      archive_.clear_event();
    }
  }
  std::string all_of(const std::shared_ptr<const RegularFile>& file) {
    std::string bytes;
    while (bytes.size() < file->size) {
      const auto chunk = archive_.submit({.kind = DiskRequest::Kind::chunk, .from = file});
      wait_for(*chunk);
      if (chunk->text().empty()) break;
      bytes += chunk->text();
    }
    return bytes;
  }

  static Settings settings_of(const fs::path& folder) {
    Settings settings;
    settings.without_token = Role::none;
    settings.operate_socket = "somewhere";
    settings.recordings = folder;
    return settings;
  }

  const ScratchFolder scratch_;
  fs::path folder_ = scratch_.path();
  Settings settings_ = settings_of(folder_);
  Gate gate_{settings_, *Tokens::parse("look " + look + "\noperate " + operate)};
  LiveState state_;
  Archive archive_{folder_};
  ServerCounts counts_;
  Site site_{settings_, gate_, state_, counts_, "draw()"};
};

TEST_F(SiteTest, ThePageIsPublicButTheDataNeedAToken) {
  const Outcome page = get("/");
  EXPECT_EQ(page.status, 200);
  EXPECT_NE(page.bytes.find("Content-Security-Policy: default-src 'none'"), std::string::npos);
  EXPECT_NE(page.bytes.find("X-Frame-Options: DENY"), std::string::npos);
  for (const char* path : {"/page.css", "/page.js", "/chart.js", "/api/session"})
    EXPECT_EQ(get(path).status, 200) << path;
  for (const char* path :
       {"/metrics", "/api/status", "/api/stream", "/api/recordings", "/recordings/run-1/picture.svg"})
    EXPECT_EQ(get(path).status, 401) << path;
}

TEST_F(SiteTest, AViewerReadsAndOnlyAnOperatorSendsCommands) {
  EXPECT_EQ(get("/metrics", look).status, 200);
  EXPECT_EQ(get("/api/status", look).status, 503) << "no daemon has sent a status";
  state_.set_status({{"time_s", 1.0}, {"state", "idle"}});
  EXPECT_EQ(get("/api/status", look).status, 200);
  const Outcome refused = ask("POST", "/api/command", look, R"({"command":"stop"})");
  EXPECT_EQ(refused.status, 403);
  EXPECT_FALSE(refused.command);
  const Outcome accepted_command = ask("POST", "/api/command", operate, R"({"command":"stop"})");
  ASSERT_TRUE(accepted_command.command);
  EXPECT_EQ((*accepted_command.command)["command"], "stop");
}

TEST_F(SiteTest, ReturnsTheReplyOfTheDaemon) {
  const Json good{{"ok", true}, {"result", {{"request", 7}}}};
  const Outcome accepted = ask("POST", "/api/command", operate, R"({"command":"stop"})", &good);
  EXPECT_EQ(accepted.status, 200);
  EXPECT_NE(accepted.bytes.find(R"({"request":7})"), std::string::npos);
  const Json bad{{"ok", false}, {"error", {{"code", "refused"}, {"message", "not now"}}}};
  const Outcome refused = ask("POST", "/api/command", operate, R"({"command":"stop"})", &bad);
  EXPECT_EQ(refused.status, 409);
  EXPECT_NE(refused.bytes.find("not now"), std::string::npos);
}

TEST_F(SiteTest, ServesOnlyViewableFilesOfARecording) {
  const Outcome picture = get("/recordings/run-1/picture.svg", look);
  EXPECT_EQ(picture.status, 200);
  EXPECT_NE(picture.bytes.find("<svg/>"), std::string::npos);
  EXPECT_NE(picture.bytes.find("sandbox"), std::string::npos);
  for (const char* path :
       {"/recordings/run-1/secret.txt", "/recordings/run-1/link.svg", "/recordings/../outside.svg",
        "/recordings/run-1/../outside.svg", "/recordings/%2e%2e/outside.svg",
        "/recordings/run-1/..%2foutside.svg", "/recordings/run-1%2f../outside.svg",
        "/recordings//outside.svg", "/recordings/run-1/picture.svg%00.txt", "/recordings/run-1/",
        "/recordings/run-1", "/recordings/.svg/x.svg", "/../outside.svg", "/outside.svg"}) {
    const Outcome refused = get(path, look);
    EXPECT_EQ(refused.status, 404) << path;
    EXPECT_EQ(refused.bytes.find("secret"), std::string::npos) << path;
  }
  EXPECT_NE(
      get("/api/recordings", look).bytes.find(R"([{"name":"run-1","files":["link.svg","picture.svg"]}])"),
      std::string::npos);
}

TEST_F(SiteTest, TheHeaderStatesTheLengthOfAFile) {
  const std::string whole(100'000, 'x');
  std::ofstream(folder_ / "run-1" / "long.csv") << whole;
  std::ofstream(folder_ / "run-1" / "empty.csv");
  const Outcome file = get("/recordings/run-1/long.csv", look);
  ASSERT_TRUE(file.file);
  EXPECT_NE(file.bytes.find("Content-Length: 100000\r\n"), std::string::npos);
  EXPECT_NE(file.bytes.find("Content-Type: text/csv"), std::string::npos);
  EXPECT_TRUE(file.bytes.ends_with("\r\n\r\n" + whole));
  const Outcome head = ask("HEAD", "/recordings/run-1/long.csv", look);
  EXPECT_FALSE(head.file);
  EXPECT_NE(head.bytes.find("Content-Length: 100000\r\n"), std::string::npos);
  const Outcome empty = get("/recordings/run-1/empty.csv", look);
  EXPECT_EQ(empty.status, 200);
  EXPECT_NE(empty.bytes.find("Content-Length: 0\r\n"), std::string::npos);
}

TEST_F(SiteTest, AnUnresponsiveDiskCausesStatus503) {
  const DiskTask silent{DiskRequest{}};
  for (const char* path : {"/api/recordings", "/recordings/run-1/picture.svg"}) {
    const std::string request = std::string("GET ") + path + " HTTP/1.1\r\nHost: localhost:1\r\n" +
                                "Authorization: Bearer " + look + "\r\n\r\n";
    EXPECT_TRUE(site_.serve(request, 0).disk_request) << path;
    const Outcome timed_out_outcome = site_.serve(request, 0, {.disk = &silent});
    EXPECT_EQ(timed_out_outcome.status, 503) << path;
    EXPECT_NE(timed_out_outcome.bytes.find("does not respond"), std::string::npos) << path;
  }
}

TEST_F(SiteTest, MetricsDoNotNeedAResponsiveDisk) {
  state_.set_health({{"made_unix_s", 7}, {"fingers", Json::array()}});
  const DiskTask silent{DiskRequest{}};
  const std::string request =
      "GET /metrics HTTP/1.1\r\nHost: localhost:1\r\nAuthorization: Bearer " + look + "\r\n\r\n";
  EXPECT_TRUE(site_.serve(request, 0).disk_request);
  const Outcome metrics = site_.serve(request, 0, {.disk = &silent});
  EXPECT_EQ(metrics.status, 200);
  EXPECT_NE(metrics.bytes.find("softgrip_health_timestamp_seconds 7\n"), std::string::npos) << metrics.bytes;
}

TEST_F(SiteTest, AStreamBeginsWithTheCurrentStatus) {
  state_.set_status({{"time_s", 1.0}, {"state", "idle"}});
  const Outcome stream = get("/api/stream", look);
  EXPECT_EQ(stream.status, 200);
  ASSERT_TRUE(stream.stream_reader);
  EXPECT_EQ(stream.stream_reader->role, Role::look);
  EXPECT_NE(stream.bytes.find("Content-Type: text/event-stream"), std::string::npos);
  EXPECT_NE(stream.bytes.find("\r\n\r\nevent: hello\ndata: {\"status\":{\"time_s\":1.0"), std::string::npos)
      << stream.bytes;
  EXPECT_EQ(stream.bytes.find("Content-Length"), std::string::npos);
}

TEST_F(SiteTest, ASessionNeedsAValidToken) {
  EXPECT_EQ(ask("POST", "/api/session", {}, R"({"token":"x"})").status, 403)
      << "the request has no Origin header";
  const auto post = [&](const std::string& body) {
    return site_.serve(
        "POST /api/session HTTP/1.1\r\nHost: localhost:1\r\nOrigin: http://localhost:1\r\n"
        "Content-Type: application/json\r\nContent-Length: " +
            std::to_string(body.size()) + "\r\n\r\n" + body,
        0);
  };
  EXPECT_EQ(post(R"({"token":"wrong"})").status, 401);
  EXPECT_EQ(post("x").status, 400);
  const Outcome opened = post(R"({"token":")" + operate + "\"}");
  EXPECT_EQ(opened.status, 200);
  EXPECT_NE(opened.bytes.find("HttpOnly; SameSite=Strict"), std::string::npos);
}

TEST_F(SiteTest, SendsNoCompressedResponse) {
  for (const char* path : {"/chart.js", "/page.js", "/"}) {
    const Outcome answered = site_.serve(
        std::string("GET ") + path +
            " HTTP/1.1\r\nHost: localhost\r\nACCEPT-encoding: gzip\r\nAccept-Encoding: br\r\n\r\n",
        0);
    EXPECT_EQ(answered.status, 200) << path;
    EXPECT_EQ(answered.bytes.find("Content-Encoding"), std::string::npos) << path;
  }
}

TEST_F(SiteTest, IgnoresRangeRequests) {
  std::string ranges = "0-0";
  while (ranges.size() < 7000) ranges += ",0-1";
  const Outcome answered =
      site_.serve("GET /chart.js HTTP/1.1\r\nHost: localhost\r\nRange: bytes=" + ranges + "\r\n\r\n", 0);
  EXPECT_LT(answered.bytes.size(), 1000U);
}

}  // namespace
}  // namespace softgrip::web::site_test
