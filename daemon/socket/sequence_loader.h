#pragma once
// Loads sequences: finds their files, reads them, and fits the sequences to the rig before the loop gets
// them.

#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "control/tick/sequence.h"
#include "control/tick/settings.h"
#include "daemon/recording/sequence_store.h"
#include "document/problem.h"

namespace softgrip::daemon {

class SequenceLoader {
 public:
  /// `directory` is the folder with the sequences that clients start by name.
  SequenceLoader(control::RigSettings rig, std::string directory);

  // The load functions are thread-safe. A call takes up to 1 s per 10 s of planned motion (feedforward
  // `planned`). A call may block for ever if the directory is on a mount whose server does not respond. A
  // stop request ends the planning, and the sequence is then refused. A parameter without an argument has its
  // default.
  using Result = tl::expected<std::shared_ptr<const LoadedSequence>, document::Problems>;
  using Arguments = std::span<const control::Argument>;
  /// Loads a file at any path. The daemon's command line uses this function.
  [[nodiscard]] Result load_file(const std::string& path, Arguments arguments = {},
                                 const std::stop_token& stop = {}) const;
  /// Loads a regular file of the directory. `name` may omit the ending `.yaml` and must not lead out of the
  /// directory. If there is no such file, the message lists the existing names.
  [[nodiscard]] Result load_named(const std::string& name, Arguments arguments = {},
                                  const std::stop_token& stop = {}) const;
  /// Loads a sequence from a text. Messages use `name` in place of a file name.
  [[nodiscard]] Result load_text(const std::string& name, const std::string& text, Arguments arguments = {},
                                 const std::stop_token& stop = {}) const;

  /// A sequence file of the directory, as read from its file and not fitted to a rig.
  struct SequenceInfo {
    std::string name;  ///< name that a start request can use, without `.yaml`
    std::string about;
    std::vector<control::Parameter> parameters;
    document::Problems problems;  ///< problems because of which the sequence cannot be started
  };
  /// Returns the sequences of the directory in the order of their names, at most `most_listed`. Reads all
  /// their files, so the call may wait for the disk.
  [[nodiscard]] std::vector<SequenceInfo> list() const;
  static constexpr std::size_t most_listed = 500;

 private:
  [[nodiscard]] Result prepare_for_rig(std::optional<control::Sequence> sequence, document::Problems problems,
                                       const std::stop_token& stop) const;
  [[nodiscard]] std::vector<std::string> names() const;

  control::RigSettings rig_;
  std::string directory_;
};

}  // namespace softgrip::daemon
