#pragma once
// What in a rig file is allowed, and yet cannot be meant: limits compared with each other and with the model.

#include <cstddef>

#include "control/tick/sequence.h"
#include "document/node.h"
#include "rig/rig_file.h"

namespace softgrip::rig {

/// Warns, at the key that should be another and with what to write there, of
/// - a highest pressure at which the model's free finger goes twice as far as it may;
/// - a speed of a believable reading that is ten times what the model's finger can do within its slew limits;
/// - a finger whose burst line nobody would see: no pressure monitor, or one that is not compared.
/// Steps the models for some seconds of their time. `document` is the one that `rig` was read from.
void compare_limits(const document::Document& document, const RigFile& rig, document::Problems& problems);

/// True if a burst line or a lost supply on this channel would be a fault.
[[nodiscard]] bool sees_burst_line(const RigFile& rig, std::size_t channel);

/// Warns, at its step, of a grip that answers HOLDING by the displacement of a finger whose burst line nobody
/// would see. Once for a sequence.
void compare_grips(const control::Sequence& sequence, const RigFile& rig, document::Problems& problems);

}  // namespace softgrip::rig
