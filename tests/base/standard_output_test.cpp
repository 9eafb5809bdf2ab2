#include "base/standard_output.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>

#include "base/descriptor.h"

namespace softgrip::standard_output_test {
namespace {

/// Redirects the standard output to the file `path` and prints a line. Returns the exit code of
/// with_output_checked(). Call this function in a child process, because the redirection remains.
int end_of_a_program_that_prints_to(const char* path, ExitCode code) {
  const Descriptor target(::open(path, O_WRONLY | O_CLOEXEC));
  ::dup2(target.get(), STDOUT_FILENO);
  std::printf("a result\n");
  return static_cast<int>(with_output_checked(code, "test"));
}

TEST(StandardOutputDeathTest, AResultThatArrivedIsDone) {
  EXPECT_EXIT(::_exit(end_of_a_program_that_prints_to("/dev/null", ExitCode::done)),
              testing::ExitedWithCode(0), "");
}

TEST(StandardOutputDeathTest, AResultThatDidNotArriveIsAnIoError) {
  EXPECT_EXIT(::_exit(end_of_a_program_that_prints_to("/dev/full", ExitCode::done)),
              testing::ExitedWithCode(4),
              "test: cannot write to the standard output: No space left on device");
}

TEST(StandardOutputDeathTest, AnotherFailureMattersMore) {
  EXPECT_EXIT(::_exit(end_of_a_program_that_prints_to("/dev/full", ExitCode::not_acceptable)),
              testing::ExitedWithCode(6), "standard output");
}

}  // namespace
}  // namespace softgrip::standard_output_test
