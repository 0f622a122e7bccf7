#pragma once
// `drumlin measure`: profiles and scalars of a finished particle run; or several measured runs together.
#include "apps/command_line/command.hpp"

namespace drumlin::apps {

struct MeasureOptions {
  std::filesystem::path run;                    ///< empty: a study
  std::vector<std::filesystem::path> study;     ///< measured runs
  std::optional<std::filesystem::path> output;  ///< of a study
  double slice_width = 20;                      ///< d
  double layer_thickness = 1;                   ///< d
  double position = 0;                          ///< x of the slice, d
  std::vector<std::string> parts;               ///< beside the profiles; empty: all, "none": none (part.hpp)
  double gradient_step = 5;                     ///< d
  std::vector<double> slices;         ///< positions of the narrow slices, d; empty: spread over the surface
  double map_spacing = 1;             ///< d, of the nodes of the maps
  double map_width = 1;               ///< d, of their kernel
  std::vector<std::string> radial;    ///< centre of rings: "axis", or x and z in d; empty: none
  std::vector<double> height, width;  ///< x0, x1 of a profile over the height; z0, z1 of one over the width
  std::string grains;  ///< snapshots whose grains get their fields written, a list as in export; empty: none
  bool verbose = false;
  std::optional<std::filesystem::path> accuracy;  ///< absent: a shipped record, if there is one
  ExistingOutput existing = ExistingOutput::refuse;

  void describe(Description& d) {
    // What was measured belongs to its run as that is now: the source of the results says so.
    d.add("run", run, "RUN", "Folder of a finished run").decides(Decides::nothing);
    d.add("--study", study, "RUN",
          "Measured runs to be studied together instead: laws over the speed of rotation, the paper's table, "
          "figures")
        .decides(study.empty() ? Decides::nothing : Decides::measured);
    d.output(output, "STUDY", "Folder for the study; open its index.html");
    d.add("--slice-width", slice_width, "d", above(0), "Width of the slice, across its middle");
    d.add("--layer-thickness", layer_thickness, "d", at_least(1e-3), "Thickness of the layers");
    d.add("--position", position, "d", anything(),
          "Place of the slice along the surface, from the middle of the drum, positive downslope");
    d.add("--parts", parts, "LIST",
          "What is measured beside the profiles, the rest is neither computed nor stored; none: nothing "
          "[all of gradients, slices, sensitivity, voronoi, forces, maps]");
    d.add("--gradient-step", gradient_step, "d", above(0),
          "Derivatives along x from slices this far to either side");
    d.add("--slices", slices, "X,X,...",
          "Places of the narrow slices along the surface, d, at least 0.1 apart");
    d.add("--map-spacing", map_spacing, "d", above(0), "Distance of the nodes of the maps");
    d.add("--map-width", map_width, "d", above(0),
          "Width of their kernel, 1 to 15 times the distance of the nodes");
    d.add("--radial", radial, "X,Z",
          "Profiles over the distance from a point as well, in d and the axes of the scene, or from the axis "
          "of the circular wall: axis");
    d.add("--height", height, "X0,X1",
          "Profiles over the height as well, within a band of x in d: a silo's axis");
    d.add("--width", width, "Z0,Z1",
          "Profiles over the width as well, within a band of z in d: a silo at one height");
    d.add("--grains", grains, "LIST",
          "Snapshots of which every grain's fields are written: all, last, or numbers and ranges such as "
          "1,5,10-20");
    d.add("--verbose", verbose, "Prints every number, not the main ones alone").decides(Decides::nothing);
    d.accuracy(accuracy);
    d.existing(existing);
  }
};

int measure(const MeasureOptions&);

}  // namespace drumlin::apps
