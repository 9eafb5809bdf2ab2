#include "tools/command_line/model_input.h"

#include "model/file/model_file.h"
#include "tools/command_line/read_input.h"

namespace softgrip::tools {

tl::expected<model::Model, ExitCode> read_model(const std::string& path) {
  return read_input(path, model::load_model);
}

tl::expected<model::Model, ExitCode> read_rig_model(const std::string& path) {
  return read_input(path, model::load_rig_model);
}

}  // namespace softgrip::tools
