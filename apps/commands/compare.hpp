#pragma once
// `drumlin compare`: two runs of one geometry side by side, or all speeds of both sides.
#include "apps/command_line/command.hpp"

namespace drumlin::apps {

struct CompareOptions {
  std::filesystem::path run, flow_run;  ///< RUN or FLOWRUN each; empty: a study
  std::filesystem::path output;
  std::optional<std::filesystem::path> floor;   ///< another RUN of the first one's drum: the noise floor
  std::optional<std::filesystem::path> beside;  ///< another FLOWRUN of the drum, judged beside the second
  std::string registration = "axis";
  bool accept_unsteady = false;
  std::vector<std::filesystem::path> study;     ///< measured runs and continuum flows, in any order
  std::optional<std::filesystem::path> limits;  ///< limits by which each flow of a study is judged beside
  ExistingOutput existing = ExistingOutput::refuse;

  void describe(Description& d) {
    const Decides in_study = study.empty() ? Decides::nothing : Decides::measured;
    d.add("run", run, "RUN", "Folder of a measured run (or of a flow): what is compared with")
        .decides(Decides::measured);
    d.add("flow_run", flow_run, "FLOWRUN",
          "Folder of a continuum flow (or of another measured run): what is compared")
        .decides(Decides::measured);
    d.output(output, "REPORT", "Folder for the report; open its index.html");
    d.add("--floor", floor, "RUN2",
          "Another run of the same scene, from other random numbers: its errors against RUN are the noise "
          "floor that appears beside every error")
        .decides(Decides::measured);
    d.add("--beside", beside, "FLOWRUN2",
          "Another flow of the drum, with another law, say: how many targets it meets, and its error beside "
          "each")
        .decides(Decides::measured);
    d.add("--register", registration, "", one_of({"axis", "surface"}),
          "What lies at the same place: at the same height below the drum's axis (in layers: above the base "
          "of each side), or at the same depth below each side's own surface");
    d.add("--accept-unsteady", accept_unsteady,
          "Takes runs that their measurement does not call steady, and says so in the report");
    d.existing(existing);
    d.add(
         "--study", study, "DIR",
         "Measured runs and flows of several speeds, in any order, to be compared over the speed of rotation "
         "instead: slope, depth, decay length, which speed was calibrated and which predicted")
        .decides(in_study);
    d.add("--limits", limits, "LIMITS.toml",
          "With --study: limits by which the flows are judged as well, by both registrations, with the noise "
          "floor between seeds (data/limits/bed.toml)")
        .decides(study.empty() ? Decides::nothing : Decides::content);
  }
};

int compare(const CompareOptions&);

}  // namespace drumlin::apps
