#include "tools/command_line/model_input.h"

#include <utility>

#include "model/file/model_file.h"
#include "tools/command_line/command.h"

namespace softgrip::tools {

tl::expected<model::Model, ExitCode> read_model(const std::string& path) {
  if (const auto code = unreadable(path)) return tl::unexpected(*code);
  document::Problems problems;
  auto model = model::load_model(path, problems);
  if (!model) return tl::unexpected(refuse(problems));
  return std::move(*model);
}

}  // namespace softgrip::tools
