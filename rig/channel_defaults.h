#pragma once
// Reads the map `channel_defaults` of a rig file, which contains the keys that all channels share. Only
// rig_file*.cpp uses this file.

#include <cstddef>

#include "rig/rig_file_reader.h"

namespace softgrip::rig {

/// Completes the channels of a rig file: a key that a channel omits is taken from `channel_defaults`. Maps
/// are merged key by key. For example, a channel with `valve: {output: 0}` gets the scaling from `valve` in
/// the defaults. Lists are not merged. Nodes keep their locations in the file, so an error in a default is
/// reported once, at the location of the default.
class ChannelDefaults {
 public:
  /// Reports keys that cannot be defaults: the key `name`, and keys that apply to all channels and belong at
  /// the top level of the file.
  ChannelDefaults(Context& context, MapReader& top);

  /// Returns the channel with the default added for each key that the channel omits.
  [[nodiscard]] document::Node completed(const document::Node& channel);

  /// Marks the defaults that caused a problem with an index of at least `before`. The problems of these
  /// defaults are not reported a second time for the next channel.
  void settle(std::size_t before);

  /// Returns true if a default has an error. In this case, no channel can be checked completely.
  [[nodiscard]] bool spoiled() const noexcept { return spoiled_; }

 private:
  void fill(document::Node& own, const document::Node& shared);

  Context& context_;
  document::Node shared_;
  bool spoiled_ = false;
};

}  // namespace softgrip::rig
