#pragma once
// Reads a Sequence from a YAML file. The file format is described in docs/reference/sequence-file.md.
// Fits a sequence to a rig: finds the channels by their names and compares all values with the limits of the
// rig.

#include <optional>
#include <span>
#include <stop_token>
#include <string>

#include "control/tick/sequence.h"
#include "document/node.h"
#include "document/problem.h"

namespace softgrip::control {

/// Reads a sequence from a parsed document. The values in `arguments` come from a start request and replace
/// the defaults of the parameters. Adds all errors to `problems`. Returns nullopt if there are errors, or if
/// a part of the document could not be parsed. The sequence must be valid with its defaults, at both ends of
/// each parameter's range and with the values in `arguments`.
[[nodiscard]] std::optional<Sequence> read_sequence(const document::Document& document,
                                                    document::Problems& problems,
                                                    std::span<const Argument> arguments = {});

/// Reads a file with parse_file() and read_sequence().
[[nodiscard]] std::optional<Sequence> load_sequence(const std::string& path, document::Problems& problems,
                                                    std::span<const Argument> arguments = {});

/// Reads the sequence of a document with the values in `parameters`. Adds all errors to `problems`, and
/// returns nullopt if there are errors.
[[nodiscard]] std::optional<Sequence> read_with(const document::Document& document,
                                                const std::vector<Parameter>& parameters,
                                                document::Problems& problems);

/// Fits a sequence to a rig, and plans the motion of the channels with the feedforward `planned`
/// (control/sequences/sequence_plans.h). Adds a problem for each step that does not fit the rig. A planned
/// position that is out of reach is a warning. Returns nullopt if a step does not fit, if more motion must be
/// planned than most_planned_s permits, or if a request through `stop` ends the planning.
[[nodiscard]] std::optional<PreparedSequence> prepare(const Sequence& sequence, const RigSettings& settings,
                                                      document::Problems& problems,
                                                      const std::stop_token& stop = {});

/// Checks the lowest and the highest value of each parameter against the rig, one parameter at a time. Each
/// problem is reported at its parameter. This check computes no plan.
void check_ranges(const Sequence& sequence, const RigSettings& settings, document::Problems& problems);

}  // namespace softgrip::control
