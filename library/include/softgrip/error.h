#pragma once
/// @file
/// Exceptions of the library. Stable.
///
/// Functions that are called once (loading, fitting, construction) report errors by these exceptions.
/// Functions that are called in a control loop do not throw; they return the error as a value.

#include <stdexcept>
#include <string>

#include <softgrip/export.h>

/// softgrip: models, control, identification and diagnosis of soft pneumatic fingers.
namespace softgrip {

/// Base class of all exceptions of the library. what() is a sentence for display.
class SOFTGRIP_API Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  ~Error() override;
};

/// An invalid argument: a wrong number of values, a value that is not finite, or a value out of its range.
/// what() names the argument, the expected shape or range, and the unit.
class SOFTGRIP_API InvalidArgument : public Error {
 public:
  /// Creates the exception.
  /// @param argument  name of the argument, as in the declaration of the function
  /// @param problem   description of the error
  InvalidArgument(std::string argument, const std::string& problem);
  ~InvalidArgument() override;
  /// Returns the name of the argument, as in the declaration of the function.
  [[nodiscard]] const std::string& argument() const noexcept { return argument_; }

 private:
  std::string argument_;
};

/// A file that cannot be read or written, or whose content is refused. what() lists each problem with file,
/// line and column.
class SOFTGRIP_API FileError : public Error {
 public:
  using Error::Error;
  ~FileError() override;
};

/// Valid arguments for which no result exists, for example a model without an inverse, or logs that cannot be
/// fitted.
class SOFTGRIP_API Refused : public Error {
 public:
  using Error::Error;
  ~Refused() override;
};

/// A computation that ended early because its std::stop_token requested it.
class SOFTGRIP_API Cancelled : public Error {
 public:
  using Error::Error;
  ~Cancelled() override;
};

}  // namespace softgrip
