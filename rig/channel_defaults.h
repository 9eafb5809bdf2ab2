#pragma once
// Reads the map `channel_defaults` of a rig file, which contains the keys that all channels share. Only
// rig_file*.cpp uses this file.

#include <cstddef>

#include "rig/rig_file_reader.h"

namespace softgrip::rig {

/// Completes the channels: a key that a channel omits is taken from `channel_defaults`. Maps are merged key
/// by key. For example, a channel with `valve: {output: 0}` gets the scaling from `valve` in the defaults.
/// Lists are not merged. Nodes keep their locations in the file, so an error in a default is reported once,
/// at the default.
class ChannelDefaults {
 public:
  /// Reports keys that cannot be defaults: `name`, and keys that are at the top level of the file and apply
  /// to all channels.
  ChannelDefaults(Context& context, MapReader& top);

  /// Returns the channel, completed with the default for each key that the channel omits.
  [[nodiscard]] document::Node completed(const document::Node& channel);

  /// Marks the defaults to which the problems from index `before` on belong. These problems are then not
  /// reported again for the next channel.
  void settle(std::size_t before);

  /// Returns true if a default has an error. In this case, complete channels cannot be checked.
  [[nodiscard]] bool spoiled() const noexcept { return spoiled_; }

 private:
  void fill(document::Node& own, const document::Node& shared);

  Context& context_;
  document::Node shared_;
  bool spoiled_ = false;
};

}  // namespace softgrip::rig
