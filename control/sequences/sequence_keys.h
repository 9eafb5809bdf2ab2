#pragma once
// Declares all keys of a sequence file: names, permitted values, defaults and meanings. sequence_file.cpp and
// parameters.cpp read a file with these declarations, and docs/reference/sequence-file.md contains their
// tables.

#include <array>
#include <string_view>

#include "control/tick/sequence.h"
#include "document/schema.h"

namespace softgrip::control {

using document::Keys;

/// The values of the key `unit` of a parameter. Except `none`, these are the units with which the name of a
/// parameter may end.
inline constexpr std::array<std::string_view, 7> parameter_units{"kpa",       "mm",       "s",   "hz",
                                                                 "kpa_per_s", "mm_per_s", "none"};

/// The keys of each map of a sequence file; sequence_tables() shows the map to which each key belongs. The
/// functions that read the steps check the conditions that combine several keys.
struct SequenceKeys {
  Keys<Sequence> sequence;
  Keys<Parameter> parameter;
  Keys<Step> step;  ///< keys of every kind of step
  Keys<Target> target_mm, target_kpa, ramp, release_kpa;
  Keys<Bounds> bounds;
  Keys<Step> on_contact, failing_contact, move, tolerance, grip, hold_time, hold, release;
  Keys<Squeeze> squeeze;
  Keys<Verify> verify, verify_position, verify_pressure;
  Keys<Sine> track;
  Keys<Profile> signal, scale, points, cycles;
  Keys<Point> point;
};
[[nodiscard]] const SequenceKeys& sequence_keys();

/// Returns the keys of each table of docs/reference/sequence-file.md, with the name of the table.
[[nodiscard]] document::KeyTables sequence_tables();

}  // namespace softgrip::control
