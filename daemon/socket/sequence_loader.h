#pragma once
// Sequences for the loop: found, read, fitted to the rig, all before the loop hears of them.

#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include <tl/expected.hpp>

#include "control/tick/settings.h"
#include "daemon/recording/sequence_shelf.h"
#include "document/problem.h"

namespace softgrip::daemon {

class SequenceLoader {
 public:
  /// `directory`: where names given by clients are looked up.
  SequenceLoader(control::RigSettings rig, std::string directory);

  // Loading takes time: up to a second for ten seconds of motion where some channel's is planned (feedforward
  // `planned`), for ever where the directory is on a mount that is gone. It is thread-safe. Planning can be
  // asked to stop: the sequence is then refused for that reason.
  using Result = tl::expected<std::shared_ptr<const LoadedSequence>, document::Problems>;
  /// A file, wherever it is: what the user of the daemon's own command line named.
  [[nodiscard]] Result load_file(const std::string& path, const std::stop_token& stop = {}) const;
  /// A regular file in the directory; `name` may leave the ending `.yaml` out, and may not lead out of the
  /// directory.
  [[nodiscard]] Result load_named(const std::string& name, const std::stop_token& stop = {}) const;
  /// The text itself; `name` stands for a file name in messages.
  [[nodiscard]] Result load_text(const std::string& name, const std::string& text,
                                 const std::stop_token& stop = {}) const;

 private:
  [[nodiscard]] Result fit(std::optional<control::Sequence> sequence, document::Problems problems,
                           const std::stop_token& stop) const;

  control::RigSettings rig_;
  std::string directory_;
};

}  // namespace softgrip::daemon
