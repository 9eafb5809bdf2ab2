#pragma once
// What the channels of a rig file share: the map `channel_defaults`. Internal to rig_file*.cpp.

#include <cstddef>

#include "rig/rig_file_reader.h"

namespace softgrip::rig {

/// The keys that a channel leaves out are taken from `channel_defaults`, map by map: `valve: {output: 0}` of
/// a channel gets the scaling that stands in the `valve` of the defaults. A list is taken whole. Nodes keep
/// their places, so what is wrong with a default is told where it stands, and told once.
class ChannelDefaults {
 public:
  /// Reports what cannot be shared: a name, and what is shared at the top of the file already.
  ChannelDefaults(Context& context, MapReader& top);

  /// A channel with what it leaves out.
  [[nodiscard]] document::Node completed(const document::Node& channel);

  /// Defaults in which the problems behind the first `before` stand are not judged again for the next
  /// channel.
  void settle(std::size_t before);

  /// Some default is wrong: what follows from a channel as a whole is not known.
  [[nodiscard]] bool spoiled() const noexcept { return spoiled_; }

 private:
  void fill(document::Node& own, const document::Node& shared);

  Context& context_;
  document::Node shared_;
  bool spoiled_ = false;
};

}  // namespace softgrip::rig
