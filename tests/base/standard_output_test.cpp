#include "base/standard_output.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>

#include "base/descriptor.h"

namespace softgrip::standard_output_test {
namespace {

/// Prints a line to the file `path` and returns the exit code of with_output_checked(). Must be called in a
/// child process, because the function redirects the standard output.
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
