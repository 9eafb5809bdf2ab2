#pragma once
// Lists the values that the template of a rig file needs, for example the board. The user gives each value by
// an option, or by the answer to a question.

#include <optional>
#include <string>
#include <vector>

#include "tools/commissioning/rig_draft.h"

namespace softgrip::tools {

/// One value that the template of the rig file needs.
struct Fact {
  std::string key;    ///< name of the option, for example "board"
  std::string about;  ///< help text of the option
  int words = 1;      ///< number of words after the option; an option with one word may occur several times
  /// Returns the question and its default answer. Both depend on the values that the draft already contains.
  /// Returns nullopt if no question is needed.
  struct Question {
    std::string text;
    std::string otherwise;  ///< default answer; empty: the question has no default answer
  };
  std::optional<Question> (*question)(const RigDraft& draft);
  /// Stores the value in `draft`. Returns "" if the value is valid, otherwise an error message.
  std::string (*take)(const std::string& words, RigDraft& draft);
};

/// Returns all values in an order in which a value depends on earlier values and on no later value.
[[nodiscard]] const std::vector<Fact>& draft_facts();

}  // namespace softgrip::tools
