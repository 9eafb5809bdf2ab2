#pragma once
// Sequences for the loop: found, read, fitted to the rig, all before the loop hears of them.

#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "control/tick/parameter.h"
#include "control/tick/settings.h"
#include "daemon/recording/sequence_store.h"
#include "document/problem.h"

namespace softgrip::daemon {

class SequenceLoader {
 public:
  /// `directory`: where names given by clients are looked up.
  SequenceLoader(control::RigSettings rig, std::string directory);

  // Loading takes time: up to a second for ten seconds of motion where some channel's is planned (feedforward
  // `planned`), for ever where the directory is on a mount that is gone. It is thread-safe. Planning can be
  // asked to stop: the sequence is then refused for that reason. Parameters that are not among the arguments
  // have their defaults.
  using Result = tl::expected<std::shared_ptr<const LoadedSequence>, document::Problems>;
  using Arguments = std::span<const control::Argument>;
  /// A file, wherever it is: what the user of the daemon's own command line named.
  [[nodiscard]] Result load_file(const std::string& path, Arguments arguments = {},
                                 const std::stop_token& stop = {}) const;
  /// A regular file in the directory; `name` may leave the ending `.yaml` out, and may not lead out of the
  /// directory. A name that is none is refused with those that there are.
  [[nodiscard]] Result load_named(const std::string& name, Arguments arguments = {},
                                  const std::stop_token& stop = {}) const;
  /// The text itself; `name` stands for a file name in messages.
  [[nodiscard]] Result load_text(const std::string& name, const std::string& text, Arguments arguments = {},
                                 const std::stop_token& stop = {}) const;

  /// A file of the directory, described without a rig.
  struct Listed {
    std::string name;  ///< as a start takes it: without `.yaml`
    std::string about;
    std::vector<control::Parameter> parameters;
    document::Problems problems;  ///< why it cannot be started
  };
  /// All sequences of the directory, by name; at most `most_listed`. Reads them: takes as long as the disk
  /// does.
  [[nodiscard]] std::vector<Listed> list() const;
  static constexpr std::size_t most_listed = 500;

 private:
  [[nodiscard]] Result fit(std::optional<control::Sequence> sequence, document::Problems problems,
                           const std::stop_token& stop) const;
  [[nodiscard]] std::vector<std::string> names() const;

  control::RigSettings rig_;
  std::string directory_;
};

}  // namespace softgrip::daemon
