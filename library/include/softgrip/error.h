#pragma once
/// @file
/// Declares the exceptions of the library. The changelog announces every incompatible change of these
/// exceptions.
///
/// Functions that load data, fit models or construct objects report errors by these exceptions. Functions
/// that a control loop calls do not throw exceptions. They report errors by their return value.

#include <stdexcept>
#include <string>

#include <softgrip/export.h>

/// Namespace of softgrip: models, control, identification and diagnosis of soft pneumatic fingers.
namespace softgrip {

/// Base class of all exceptions of the library. what() returns a sentence that describes the error to the
/// user.
class SOFTGRIP_API Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  ~Error() override;
};

/// An argument is invalid: the number of its values is wrong, or a value is not finite or out of range.
/// what() names the argument, the expected number or range of values, and the unit.
class SOFTGRIP_API InvalidArgument : public Error {
 public:
  /// Creates the exception for one argument.
  /// @param argument  name of the argument, as in the declaration of the function
  /// @param problem   description of the error
  InvalidArgument(std::string argument, const std::string& problem);
  ~InvalidArgument() override;
  /// Returns the name of the invalid argument, as in the declaration of the function.
  [[nodiscard]] const std::string& argument() const noexcept { return argument_; }

 private:
  std::string argument_;
};

/// A file cannot be read or written, or its content is invalid. what() states the reason. For invalid
/// content, what() lists each problem with file, line and column.
class SOFTGRIP_API FileError : public Error {
 public:
  using Error::Error;
  ~FileError() override;
};

/// The arguments are valid, but the function cannot compute a result. Examples are a model without an
/// inverse, and logs that cannot be fitted.
class SOFTGRIP_API Refused : public Error {
 public:
  using Error::Error;
  ~Refused() override;
};

/// A computation ended early, because the caller requested this through a std::stop_token.
class SOFTGRIP_API Cancelled : public Error {
 public:
  using Error::Error;
  ~Cancelled() override;
};

}  // namespace softgrip
