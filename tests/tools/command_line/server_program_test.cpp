#include "tools/command_line/program.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <stdexcept>
#include <vector>

#include "tools/command_line/terminal.h"

namespace softgrip::tools::server_program_test {
namespace {

/// Runs a program that has the options of a gateway, and returns its exit code. `run` receives the options.
int run_with(std::vector<std::string> words, const std::function<ExitCode(const GatewayOptions&)>& run) {
  words.insert(words.begin(), "server");
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  GatewayOptions options;
  return run_server_program(
      {"server", "Serves.",
       [&](CLI::App& program) { add_gateway_options(program, options, "server.yaml", "File", "Socket"); },
       [&] { return run(options); }},
      static_cast<int>(argv.size()), argv.data());
}

ExitCode must_not_run(const GatewayOptions&) {
  ADD_FAILURE();
  return ExitCode::done;
}

TEST(ServerProgram, PassesTheOptionsAndReturnsTheExitCode) {
  std::optional<GatewayOptions> seen;
  EXPECT_EQ(run_with({"--config", "a.yaml", "--port", "502", "--check"},
                     [&](const GatewayOptions& options) {
                       seen = options;
                       return ExitCode::io;
                     }),
            static_cast<int>(ExitCode::io));
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->config, "a.yaml");
  EXPECT_EQ(seen->socket, "");
  EXPECT_EQ(seen->port, 502);
  EXPECT_TRUE(seen->check);
}

TEST(ServerProgram, DoesNotRunForAVersionOrAWrongCommandLine) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_with({"--version"}, must_not_run), 0);
  EXPECT_EQ(run_with({"--prot", "1"}, must_not_run), static_cast<int>(ExitCode::usage));
  EXPECT_EQ(testing::internal::GetCapturedStdout().rfind("server ", 0), 0U);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("did you mean `--port`?"), std::string::npos);
}

TEST(ServerProgram, PrintsAnExceptionWithTheNameOfTheProgram) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_with({}, [](const GatewayOptions&) -> ExitCode { throw std::runtime_error("no memory"); }),
            static_cast<int>(ExitCode::failed));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "server: no memory\n");
}

TEST(ServerProgram, ReceivesTerminationAndAdditionalSignalsAndIgnoresSigpipe) {
  const auto pipe_before = std::signal(SIGPIPE, SIG_DFL);
  sigset_t before;
  ::sigprocmask(SIG_BLOCK, nullptr, &before);
  {
    const Descriptor signals = take_server_signals({SIGUSR1});
    struct sigaction pipe {};
    ::sigaction(SIGPIPE, nullptr, &pipe);
    EXPECT_EQ(pipe.sa_handler, SIG_IGN) << "a client that disconnects must not end the server";
    for (const int signal : {SIGHUP, SIGINT, SIGTERM, SIGUSR1}) {
      ::raise(signal);
      EXPECT_EQ(next_signal(signals), signal);
    }
  }
  ::sigprocmask(SIG_SETMASK, &before, nullptr);
  std::signal(SIGPIPE, pipe_before);
}

}  // namespace
}  // namespace softgrip::tools::server_program_test
