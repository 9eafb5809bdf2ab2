#include "tools/command_line/command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <utility>

namespace softgrip::tools {
namespace {

/// An option or a positional argument of a command, with its allowed values.
struct Choice {
  std::vector<std::string> names;  ///< names of the option with their dashes; empty: a positional argument
  std::string about;
  bool takes_value = false;
  bool repeats = false;
  std::vector<std::string> words;  ///< allowed values of the option; empty: any file name
};

struct Command {
  std::string name;
  std::string about;
  std::vector<Choice> options;
  std::vector<Choice> places;
  bool asks_for_sequences = false;  ///< true: the allowed values are the names of the daemon's sequences
};

constexpr const char* ask_for_sequences = "sequences --names 2>/dev/null";

/// Returns the allowed values of an option with a type such as "{a,b}".
std::vector<std::string> words_of(const std::string& type) {
  std::vector<std::string> words;
  const std::size_t begin = type.find('{');
  const std::size_t end = type.find('}', begin == std::string::npos ? 0 : begin);
  if (begin == std::string::npos || end == std::string::npos) return words;
  std::string word;
  for (std::size_t i = begin + 1; i <= end; ++i) {
    if (type[i] == ',' || i == end) {
      words.push_back(std::exchange(word, {}));
    } else {
      word += type[i];
    }
  }
  return words;
}

Choice choice_of(const CLI::Option& option) {
  Choice choice;
  for (const std::string& name : option.get_lnames()) choice.names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) choice.names.push_back("-" + name);
  choice.about = option.get_description();
  choice.takes_value = option.get_expected_max() != 0;
  choice.repeats = option.get_expected_max() > 1;
  choice.words = words_of(option.get_type_name());
  return choice;
}

Command command_of(const CLI::App& app);

/// Adds the names of the subcommands as one argument of the command, and adds the options of the subcommands.
/// An option whose names the command already has is not added again.
void add_nested(const CLI::App& app, Command& command) {
  Choice place;
  for (const CLI::App* nested : app.get_subcommands([](const CLI::App*) { return true; })) {
    place.words.push_back(nested->get_name());
    for (Choice& option : command_of(*nested).options) {
      const auto same = [&](const Choice& other) { return other.names == option.names; };
      if (std::none_of(command.options.begin(), command.options.end(), same)) {
        command.options.push_back(std::move(option));
      }
    }
  }
  if (!place.words.empty()) command.places.push_back(std::move(place));
}

Command command_of(const CLI::App& app) {
  Command command{app.get_name(), app.get_description(), {}, {}, false};
  bool sequence = false;
  bool daemon = false;
  for (const CLI::Option* option : app.get_options([](const CLI::Option*) { return true; })) {
    const bool place = option->get_lnames().empty() && option->get_snames().empty();
    (place ? command.places : command.options).push_back(choice_of(*option));
    sequence = sequence || (place && option->get_name(true) == "SEQUENCE");
    daemon = daemon || option->check_lname("socket");
  }
  command.asks_for_sequences = sequence && daemon;
  add_nested(app, command);
  return command;
}

std::vector<Command> commands_of(const CLI::App& program) {
  std::vector<Command> commands;
  for (const CLI::App* app : program.get_subcommands([](const CLI::App*) { return true; })) {
    commands.push_back(command_of(*app));
  }
  return commands;
}

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::vector<std::string> names_of(const std::vector<Choice>& options) {
  std::vector<std::string> names;
  for (const Choice& option : options) names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

/// Returns `text` between quotes, with a backslash before each character that `escaped` contains.
std::string quoted(const std::string& text, std::string_view escaped, std::string_view quote) {
  std::string out;
  for (const char c : text) {
    if (c == '\'') {
      out += quote;
    } else if (c == '\n') {
      out += ' ';
    } else {
      if (escaped.find(c) != std::string_view::npos) out += '\\';
      out += c;
    }
  }
  return out;
}

// Functions that write the completion script for bash. If there are no candidates for an argument, the option
// `-o default` of bash completes the argument as a file name.

void bash_values(std::string& out, const std::string& command, const std::vector<Choice>& options) {
  for (const Choice& option : options) {
    if (!option.takes_value) continue;
    std::vector<std::string> cases;
    for (const std::string& name : option.names) cases.push_back("'" + command + " " + name + "'");
    out += "    " + joined(cases, " | ") + ")";
    if (!option.words.empty()) {
      out += " mapfile -t COMPREPLY < <(compgen -W '" + joined(option.words, " ") + "' -- \"$word\");";
    }
    out += " return ;;\n";
  }
}

void bash_words(std::string& out, const std::string& program, const Command& command) {
  out += "    " + command.name + ") options='" + joined(names_of(command.options), " ") + "'";
  std::vector<std::string> words;
  for (const Choice& place : command.places)
    words.insert(words.end(), place.words.begin(), place.words.end());
  if (!words.empty()) out += " words='" + joined(words, " ") + "'";
  if (command.asks_for_sequences) {
    out += " words=\"$(" + program + " " + ask_for_sequences + ") $(compgen -f -- \"$word\")\"";
  }
  out += " ;;\n";
}

std::string bash_script(const std::string& program, const Command& top,
                        const std::vector<Command>& commands) {
  std::vector<std::string> names;
  names.reserve(commands.size());
  for (const Command& command : commands) names.push_back(command.name);
  std::string out = "# bash completion of " + program + ", made by `" + program + " completion bash`\n_" +
                    program +
                    "() {\n"
                    "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n"
                    "  local command= options= words= i\n"
                    "  COMPREPLY=()\n"
                    "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
                    "    case ${COMP_WORDS[i]} in\n      " +
                    joined(names, " | ") +
                    ") command=${COMP_WORDS[i]}; break ;;\n    esac\n  done\n"
                    "  case \"$command $before\" in\n";
  for (const Command& command : commands) bash_values(out, command.name, command.options);
  out += "  esac\n  case $command in\n    '') options='" + joined(names_of(top.options), " ") + "' words='" +
         joined(names, " ") + "' ;;\n";
  for (const Command& command : commands) bash_words(out, program, command);
  out +=
      "  esac\n"
      "  if [[ $word == -* ]]; then words=$options; fi\n"
      "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n"
      "}\n"
      "complete -o default -F _" +
      program + " " + program + "\n";
  return out;
}

// Functions that write the completion script for zsh.

std::string zsh_value(const Choice& choice) {
  return choice.words.empty() ? ":file:_files" : ":word:(" + joined(choice.words, " ") + ")";
}

void zsh_arguments(std::string& out, const std::string& program, const Command& command,
                   const std::string& indent) {
  for (const Choice& option : command.options) {
    const std::string about = "[" + quoted(option.about, "[]:\\", "'\\''") + "]";
    const std::string value = option.takes_value ? zsh_value(option) : "";
    for (const std::string& name : option.names) {
      const std::string others =
          option.names.size() > 1 && !option.repeats ? "(" + joined(option.names, " ") + ")" : "";
      out += " \\\n" + indent + "'" + others + (option.repeats ? "*" : "") + name + about + value + "'";
    }
  }
  if (command.asks_for_sequences) {
    out +=
        " \\\n" + indent + "'*:sequence:{compadd -- $(" + program + " " + ask_for_sequences + "); _files}'";
  } else {
    for (const Choice& place : command.places) {
      out += " \\\n" + indent + "'" + (place.repeats ? "*" : "") + zsh_value(place) + "'";
    }
  }
  out += "\n";
}

std::string zsh_script(const std::string& program, const Command& top, const std::vector<Command>& commands) {
  std::string out = "#compdef " + program + "\n# made by `" + program + " completion zsh`\n_" + program +
                    "() {\n  local curcontext=$curcontext state line\n  local -a commands\n  commands=(\n";
  for (const Command& command : commands) {
    out += "    '" + command.name + ":" + quoted(command.about, ":\\", "'\\''") + "'\n";
  }
  out += "  )\n  _arguments -C";
  Command bare = top;
  bare.places.clear();
  std::string options;
  zsh_arguments(options, program, bare, "    ");
  options.pop_back();
  out += options +
         " \\\n    '1:command:->command' '*::argument:->argument'\n  case $state in\n"
         "    command) _describe command commands ;;\n"
         "    argument)\n      case $line[1] in\n";
  for (const Command& command : commands) {
    out += "        " + command.name + ") _arguments";
    zsh_arguments(out, program, command, "          ");
    out += "          ;;\n";
  }
  return out + "      esac ;;\n  esac\n}\nif [[ $funcstack[1] == _" + program + " ]]; then\n  _" + program +
         " \"$@\"\nelse\n  compdef _" + program + " " + program + "\nfi\n";
}

// Functions that write the completion script for fish.

void fish_options(std::string& out, const std::string& begin, const Command& command) {
  for (const Choice& option : command.options) {
    out += begin;
    for (const std::string& name : option.names) {
      out += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    }
    if (!option.words.empty()) {
      out += " -x -a '" + joined(option.words, " ") + "'";
    } else if (option.takes_value) {
      out += " -r";
    }
    out += " -d '" + quoted(option.about, "\\", "\\'") + "'\n";
  }
}

std::string fish_script(const std::string& program, const Command& top,
                        const std::vector<Command>& commands) {
  const std::string complete = "complete -c " + program;
  std::string out = "# fish completion of " + program + ", made by `" + program + " completion fish`\n";
  fish_options(out, complete + " -n __fish_use_subcommand", top);
  for (const Command& command : commands) {
    out += complete + " -f -n __fish_use_subcommand -a " + command.name + " -d '" +
           quoted(command.about, "\\", "\\'") + "'\n";
  }
  for (const Command& command : commands) {
    const std::string begin = complete + " -n '__fish_seen_subcommand_from " + command.name + "'";
    fish_options(out, begin, command);
    for (const Choice& place : command.places) {
      if (!place.words.empty()) out += begin + " -f -a '" + joined(place.words, " ") + "'\n";
    }
    if (command.asks_for_sequences) {
      out += begin + " -a '(" + program + " " + ask_for_sequences + ")'\n";
    }
  }
  return out;
}

}  // namespace

std::optional<Shell> shell_named(std::string_view name) {
  if (name == "bash") return Shell::bash;
  if (name == "zsh") return Shell::zsh;
  if (name == "fish") return Shell::fish;
  return std::nullopt;
}

std::string completion_script(const CLI::App& program, Shell shell) {
  Command top{program.get_name(), program.get_description(), {}, {}, false};
  for (const CLI::Option* option : program.get_options([](const CLI::Option*) { return true; })) {
    top.options.push_back(choice_of(*option));
  }
  const std::vector<Command> commands = commands_of(program);
  switch (shell) {
    case Shell::bash:
      return bash_script(top.name, top, commands);
    case Shell::zsh:
      return zsh_script(top.name, top, commands);
    case Shell::fish:
      break;
  }
  return fish_script(top.name, top, commands);
}

}  // namespace softgrip::tools
