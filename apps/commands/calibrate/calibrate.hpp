#pragma once
// `drumlin calibrate`: one law from the tensors or profiles of one or more runs.
#include "apps/command_line/command.hpp"
#include "coupling/core/law/friction_law.hpp"

namespace drumlin::apps {

struct CalibrateOptions {
  std::vector<std::filesystem::path> runs;
  std::vector<std::filesystem::path> validate;
  std::filesystem::path output;
  std::string from = "auto";    ///< auto: maps where all runs are drums and have them
  std::string law = "auto";     ///< auto: table where there are points enough, else log
  std::optional<double> I_min;  ///< absent: 1e-4 of profiles, 3e-5 of maps
  std::optional<double> I_max;  ///< absent: 1e-1 of a drum's profiles, 1 of maps and of layers
  int draws = 200;
  bool k = false, misalignment = false, memory = false, nonlocal = false, amount = false;
  double own_weight = 0;  ///< rho0 g d
  bool accept_unsteady = false;
  ExistingOutput existing = ExistingOutput::refuse;

  void describe(Description& d) {
    d.add("runs", runs, "RUN", "Folders of measured runs").required().decides(Decides::measured);
    d.output(output, "RHEOLOGY.toml", "File for the law");
    d.add("--validate", validate, "RUN", "Runs that the law is not fitted on: how well it predicts them")
        .decides(Decides::measured);
    d.add(
        "--from", from, "", one_of({"auto", "maps", "profiles"}),
        "The tensors of maps.h5 (stress along the strain rate), or the ratio of profiles.csv at the centre");
    std::vector<std::string> forms = fitted_names();
    forms.insert(forms.begin(), "auto");
    d.add("--law", law, "", one_of(forms),
          "Form of mu(I): a + b ln I, a + b ln I + c I, that of Jop et al., points");
    d.add("--I-min", I_min, "", above(0), "Least inertial number that is fitted");
    d.add("--I-max", I_max, "", above(0), "Greatest one");
    d.add("--draws", draws, "", at_least(16, 10000),
          "Draws of the points for the 99 % band, which fewer than 199 do not hold");
    d.add("--k", k, "Ratio of the normal stresses k(I) as a part of the law");
    d.add("--misalignment", misalignment,
          "Angle between the axes of stress and strain rate over I (from maps)");
    d.add("--memory", memory,
          "Memory of the axes of stress as a part of the law: amount of the stress over I, share renewed by "
          "strain, and what the runs cannot tell of them (from maps)");
    d.add("--nonlocal", nonlocal,
          "Threshold and length of nonlocal fluidity as a part of the law, and whether the runs need them "
          "(from maps)");
    d.add("--amount", amount,
          "With --memory: what is added to the amount of the stress: creep, dilatancy and lag of the axes, "
          "as a part of the law")
        .needs("--memory");
    d.add("--own-weight", own_weight, "rho0 g d", at_least(0, 100),
          "With --amount: w in the law's I = 2|D|/sqrt(p + w)")
        .needs("--amount");
    d.add("--accept-unsteady", accept_unsteady,
          "Takes runs that their measurement does not call steady, and says so");
    d.existing(existing);
  }
};

int calibrate(const CalibrateOptions&);

}  // namespace drumlin::apps
