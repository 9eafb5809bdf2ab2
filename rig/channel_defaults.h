#pragma once
// Reads the map `channel_defaults` of a rig file: the keys that all channels share. Internal to
// rig_file*.cpp.

#include <cstddef>

#include "rig/rig_file_reader.h"

namespace softgrip::rig {

/// Completes the channels: a key that a channel omits is taken from `channel_defaults`. Maps are merged key
/// by key. For example, a channel with `valve: {output: 0}` gets the scaling of `valve` in the defaults.
/// Lists are not merged. Nodes keep their places in the file, so an error in a default is reported once, at
/// the default.
class ChannelDefaults {
 public:
  /// Reports keys that cannot be defaults: a name, and keys that are shared at the top of the file.
  ChannelDefaults(Context& context, MapReader& top);

  /// Returns the channel with the default for each key that the channel omits.
  [[nodiscard]] document::Node completed(const document::Node& channel);

  /// Marks the defaults that have a problem with index `before` or above, so that they are not reported again
  /// for the next channel.
  void settle(std::size_t before);

  /// Returns true if a default has an error. Checks of a complete channel are then not possible.
  [[nodiscard]] bool spoiled() const noexcept { return spoiled_; }

 private:
  void fill(document::Node& own, const document::Node& shared);

  Context& context_;
  document::Node shared_;
  bool spoiled_ = false;
};

}  // namespace softgrip::rig
