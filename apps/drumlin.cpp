// The drumlin command: words to options, options to a command.
#include "apps/command_line/command_line.hpp"
#include "apps/commands/all_commands.hpp"
#include "apps/output/program.hpp"
#include "apps/process/standard_streams.hpp"

int main(int argc, char** argv) {
  using namespace drumlin::apps;
  return run_program([&] {
    const auto request = parse_command_line(argc, argv, all_commands());
    if (const auto* shown = std::get_if<TextToShow>(&request)) {
      print_out(shown->text);
      return 0;
    }
    return std::get<1>(request)->carry_out();
  });
}
