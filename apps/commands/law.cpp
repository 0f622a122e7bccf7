// drumlin law: the law of given grains, from the library of laws by library/command.py of the Python package.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/command_line/command.hpp"
#include "apps/output/figures.hpp"
#include "apps/output/output_folder.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/law/rheology_file.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct LawOptions {
  double friction = 0, restitution = 0.1, spread = 0.2, rolling_resistance = 0;
  fs::path output;
  bool extrapolate = false;
  ExistingOutput existing = ExistingOutput::refuse;

  void describe(Description& d) {
    d.add("--friction", friction, "", at_least(0, 100), "Coefficient between grains").required();
    d.add("--restitution", restitution, "", at_least(0, 1), "Coefficient between grains");
    d.add("--spread", spread, "", at_least(0, 1),
          "Sizes, evenly, of the mean times 1 +- this; of others sqrt(3) standard deviation over mean");
    d.add("--rolling-resistance", rolling_resistance, "", at_least(0, 100), "Coefficient between grains");
    d.output(output, "LAW.toml", "File for the law");
    d.add("--extrapolate", extrapolate, "Goes on beyond the table, and says so");
    d.overwrite(existing, "Replaces a file that is there");
  }
};

Json law_of(const LawOptions& options) {
  const Json given{{"friction", options.friction},
                   {"restitution", options.restitution},
                   {"spread", options.spread},
                   {"rolling_resistance", options.rolling_resistance},
                   {"extrapolate", options.extrapolate}};
  return Json::parse(output_of_script("../library/command.py", {given.dump()}));
}

int law(const LawOptions& options) {
  const FolderLock lock = prepare_output_file(options.output, options.existing);
  const Json found = law_of(options);
  const auto text = found.at("text").get<std::string>();
  (void)parse_rheology(text, options.output.string());
  replace_file(options.output, text);
  print_out(fmt::format("{}: mu = {:.3f} at I = {:.2g} (99 %: {:.3f} to {:.3f}), nu = {:.3f} at rest\n",
                        options.output.string(), found.at("mu").get<double>(), found.at("I").get<double>(),
                        found.at("low").get<double>(), found.at("high").get<double>(),
                        found.at("nu").get<double>()));
  for (const auto& outside : found.at("extrapolates"))
    print_out("extrapolates: " + outside.get<std::string>() + "\n");
  return static_cast<int>(ExitCode::done);
}

}  // namespace

Command law_command() { return command("law", "The law of given grains, from the library of laws", law); }

}  // namespace drumlin::apps
