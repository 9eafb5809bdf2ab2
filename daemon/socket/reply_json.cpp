#include "daemon/socket/reply_json.h"

#include "daemon/recording/csv_row.h"
#include "daemon/socket/status_json.h"

namespace softgrip::daemon {

using Json = nlohmann::ordered_json;

namespace {

Json json_of(const document::Problem& problem) {
  return {{"file", problem.file},           {"line", problem.at.line},    {"column", problem.at.column},
          {"line_text", problem.line_text}, {"message", problem.message}, {"hint", problem.hint}};
}

Json json_of(const control::Parameter& parameter) {
  return {{"name", parameter.name},
          {"unit", parameter.unit},
          {"lower", parameter.lower},
          {"upper", parameter.upper},
          {"default", parameter.default_value},
          {"about", parameter.about}};
}

}  // namespace

Json id_json(std::optional<std::uint64_t> id) {
  return id ? Json(*id) : Json(nullptr);
}

Json error_json(std::string_view code, std::string_view message) {
  return {{"code", code}, {"message", message}};
}

Json problems_json(const std::vector<document::Problem>& problems) {
  Json list = Json::array();
  for (const document::Problem& problem : problems) list.push_back(json_of(problem));
  return list;
}

Json sequences_json(const std::vector<SequenceLoader::SequenceInfo>& sequences) {
  Json list = Json::array();
  for (const SequenceLoader::SequenceInfo& info : sequences) {
    Json parameters = Json::array();
    for (const control::Parameter& parameter : info.parameters) parameters.push_back(json_of(parameter));
    list.push_back({{"name", info.name},
                    {"about", info.about},
                    {"parameters", std::move(parameters)},
                    {"problems", problems_json(info.problems.list())}});
  }
  return list;
}

Json checked_json(const LoadedSequence& sequence) {
  const control::PreparedSequence& prepared = sequence.prepared;
  return {{"name", prepared.name},
          {"parameters", parameters_json(prepared.parameters)},
          {"steps", prepared.steps.size()}};
}

Json hello_json(const HelloData& hello, const rig::SocketSettings& settings) {
  Json commands = Json::array();
  for (const std::string_view name : commands_of(hello.role)) commands.push_back(name);
  Json capabilities = Json::array({"event_ids", "overall_result", "owner", "start_id"});
  if (hello.role == Role::operate) capabilities.push_back("dry_run");
  return {{"api", api_version},
          {"version", hello.software_version},
          {"started_at", hello.started_at},
          {"role", name_of(hello.role)},
          {"read_only", hello.role == Role::look},
          {"client", hello.client.empty() ? Json(nullptr) : Json(hello.client)},
          {"commands", std::move(commands)},
          {"capabilities", std::move(capabilities)},
          {"bounds",
           {{"longest_answer_s", hello.reply_timeout_s},
            {"max_clients", settings.max_clients},
            {"max_line_bytes", settings.max_line_bytes},
            {"max_queue_bytes", settings.max_queue_bytes}}}};
}

std::string error_line(std::optional<std::uint64_t> id, std::string_view code, std::string_view message) {
  return line_of({{"id", id_json(id)}, {"ok", false}, {"error", error_json(code, message)}});
}

}  // namespace softgrip::daemon
