#pragma once
// `drumlin measure`: profiles and scalars of a finished particle run; or several measured runs together.
#include "apps/command_line/command.hpp"

namespace drumlin::apps {

struct MeasureOptions {
  std::vector<std::filesystem::path> runs;      ///< empty: a study; several: frames
  std::vector<std::filesystem::path> study;     ///< measured runs
  std::optional<std::filesystem::path> output;  ///< of a study or of frames
  std::optional<double> since;                  ///< s; absent: all snapshots of the last motion
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
  std::vector<std::string> at;        ///< times of frames, s since `origin`; empty: no frames
  std::optional<double> origin;       ///< s; absent: 0
  std::vector<double> x, z;           ///< x0, x1 and z0, z1 of the nodes of frames, d; empty: of all grains
  std::optional<double> nu_bulk;      ///< of frames; absent: of the fill at the origin
  std::string along = "y";            ///< axis along which spheres are seen
  std::vector<double> slab;           ///< from and to along it, d; empty: all of them
  std::string grains;  ///< snapshots whose grains get their fields written, a list as in export; empty: none
  bool verbose = false, no_figures = false;
  std::optional<std::filesystem::path> accuracy;  ///< absent: a shipped record, if there is one
  ExistingOutput existing = ExistingOutput::refuse;

  const std::filesystem::path& run() const { return runs.front(); }

  void describe(Description& d) {
    // What was measured belongs to its run as that is now: the source of the results says so.
    d.add("run", runs, "RUN", "Folder of a finished run; of several with --at").decides(Decides::nothing);
    d.add("--study", study, "RUN",
          "Measured runs to be studied together instead: laws over the speed of rotation, the paper's table, "
          "figures")
        .decides(study.empty() ? Decides::nothing : Decides::measured);
    d.output(output, "DIR", "Folder for the study, open its index.html; for the frames of --at");
    d.add("--at", at, "TIMES",
          "Fields, surface and loads at these times of all runs instead, side by side in frames.h5: seconds "
          "since --origin, or from:to:step")
        .needs("--output")
        .excludes("--study");
    d.add("--origin", origin, "s", anything(), "Time of the scene that is 0 for --at; absent: its start")
        .needs("--at");
    d.add("--x", x, "X0,X1", "Nodes of --at from X0 to X1, in d; absent: around all grains").needs("--at");
    d.add("--z", z, "Z0,Z1", "Nodes of --at from Z0 to Z1, in d; absent: around all grains").needs("--at");
    d.add("--nu-bulk", nu_bulk, "", above(0, 1),
          "Volume fraction of the bulk for --at; absent: of the fill at the origin")
        .needs("--at");
    d.add("--since", since, "s", anything(), "Snapshots from this time on alone: the start is not steady")
        .excludes("--at")
        .excludes("--study");
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
    d.add("--along", along, "", one_of({"x", "y", "z"}),
          "Axis along which spheres are seen and averaged; z becomes the height of the view unless it is "
          "that axis");
    d.add("--slab", slab, "A,B", "Spheres with their centres from A to B along that axis alone, in d");
    d.add("--grains", grains, "LIST",
          "Snapshots of which every grain's fields are written: all, last, or numbers and ranges such as "
          "1,5,10-20");
    d.add("--no-figures", no_figures, "Draws none").excludes("--study");
    d.add("--verbose", verbose, "Prints every number, not the main ones alone").decides(Decides::nothing);
    d.accuracy(accuracy);
    d.existing(existing);
  }
};

int measure(const MeasureOptions&);

}  // namespace drumlin::apps
