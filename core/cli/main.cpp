// The program `weft`: its commands, and how whatever goes wrong becomes a line and an exit code.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>

#include "commands.h"
#include "failure.h"
#include "weft/output.h"
#include "weft/standard_streams.h"

namespace weft::cli {

namespace {

constexpr const char* kFooter = R"(
First steps:
  weft scenes                              what there is to run
  weft run pinned2                         run a shipped scene
  weft run my.json --export my.pc2         run one's own, and keep the animation
  weft check my.json                       what is wrong with it?
  weft run my.json --set /solver/iterations=20 --report my_report.json

Exit codes: 0 done, 2 the command line is wrong, 3 the scene is wrong,
4 the simulation stopped itself, 5 a file could not be written, 128 + n signal n ended it.

Files appear whole or not at all, at the end of a run. Ctrl-C, SIGTERM and SIGHUP end a run after
the present frame, with all files; where the frame takes more than two seconds more, within it,
with the animation and the recording of the frames before. A second Ctrl-C ends it at once.)";

void add_commands(CLI::App& program, int& exit_code) {
  add_run(program, exit_code);
  add_check(program, exit_code);
  add_explain(program, exit_code);
  add_scenes(program, exit_code);
#ifdef WEFT_STUDY
  add_study(program, exit_code);
#endif
  add_view(program, exit_code);
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_lnames().empty()) names.push_back("--" + option->get_lnames().front());
  }
  return names;
}

std::vector<std::string> command_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

// What the parser objects to, in our words: place, what, what is allowed.
Fault usage_fault(const CLI::App& program, const CLI::ParseError& error) {
  const std::vector<std::string> rest = program.remaining(true);
  const std::vector<CLI::App*> chosen = program.get_subcommands();
  if (chosen.empty()) {
    const std::string allowed = list(command_names(program)) + "; `weft --help` tells more";
    if (rest.empty()) return {"command line", "a command is needed", allowed};
    return {rest.front(), "no such command", allowed};
  }
  const CLI::App& command = *chosen.front();
  const std::string& name = command.get_name();
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr && !rest.empty()) {
    const auto option =
        std::ranges::find_if(rest, [](auto& word) { return word.starts_with('-'); });
    if (option == rest.end()) return {rest.front(), "not expected here", "one SCENE only"};
    return {*option, "no such option", name + " takes " + list(option_names(command))};
  }
  // The parser's own messages read "--option: what" when they are about one option.
  const std::string text = error.what();
  const std::string help = "`weft " + name + " --help` tells more";
  const std::size_t colon = text.starts_with("--") ? text.find(": ") : std::string::npos;
  if (colon == std::string::npos) return {"command line", text, help};
  const bool says_allowed = text.ends_with(')');
  return {text.substr(0, colon), text.substr(colon + 2), says_allowed ? "" : help};
}

int run_program(int argument_count, char** arguments) {
  int exit_code = kDone;
  CLI::App program{"Weft: fast and accurate cloth simulation on the CPU", "weft"};
  program.set_version_flag("--version", "weft " WEFT_VERSION, "Print the version");
  program.require_subcommand(1);
  add_commands(program, exit_code);
  program.footer(kFooter);  // after the commands, which would show it, too
  try {
    program.parse(argument_count, arguments);
  } catch (const CLI::Success& asked) {  // --help, --version
    program.exit(asked);
  } catch (const CLI::ParseError& error) {
    print({usage_fault(program, error)});
    return kBadCommandLine;
  } catch (const Failure& failure) {
    std::cout.flush();
    print(failure.faults);
    return failure.exit_code;
  } catch (const WriteError& error) {
    print({{error.path, error.what(), ""}});
    return kNotWritten;
  }
  if (!std::cout.flush()) {
    print({{"standard output", "writing failed", ""}});
    return kNotWritten;
  }
  return exit_code;
}

}  // namespace

}  // namespace weft::cli

int main(int argument_count, char** arguments) {
  weft::occupy_standard_streams();
  try {
    return weft::cli::run_program(argument_count, arguments);
  } catch (const std::bad_alloc&) {
    std::fputs(
        "weft: error: memory: the system gives no more (`weft check SCENE` says what a run "
        "needs)\n",
        stderr);
  } catch (const std::exception& error) {
    weft::cli::print({{"internal", error.what(), ""}});
  }
  return weft::cli::kStopped;
}
