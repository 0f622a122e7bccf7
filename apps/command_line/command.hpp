#pragma once
// A command: its name, its options, and the function that does it.
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/command_line/options.hpp"

namespace drumlin::apps {

/// One call of a command: its options, to be filled in, and its work.
class Call {
 public:
  virtual ~Call() = default;
  virtual Description description() const = 0;
  /// Returns the exit code; throws the errors of coupling/core/basics/errors.hpp.
  virtual int carry_out() const = 0;
};

template <class Options>
class CallOf : public Call {
 public:
  explicit CallOf(int (*function)(const Options&)) : function_(function) {}
  Description description() const override { return described(options); }
  int carry_out() const override { return function_(options); }

  Options options;

 private:
  int (*function_)(const Options&);
};

struct Command {
  std::string name, sentence;
  std::function<std::unique_ptr<Call>()> call;  ///< with the options as they are by default
  std::vector<Command> subcommands = {};        ///< in place of a call
  std::vector<std::string> examples = {};       ///< as a user types them
};

template <class Options>
Command command(std::string name, std::string sentence, int (*function)(const Options&)) {
  return {std::move(name), std::move(sentence),
          [function] { return std::make_unique<CallOf<Options>>(function); }};
}

}  // namespace drumlin::apps
