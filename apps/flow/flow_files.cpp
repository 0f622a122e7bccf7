#include "apps/flow/flow_files.hpp"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>

#include "apps/flow/flow_json.hpp"
#include "apps/json/json_file.hpp"
#include "apps/output/figures.hpp"
#include "continuum/io/flow_state_file.hpp"
#include "coupling/core/basics/provenance.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/files/unfinished_file.hpp"
#include "coupling/core/hdf5/field_map_file.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

ProfileSet profiles_with_header(const FinishedFlow& flow) {
  ProfileSet profiles = flow.asked.flow_case.profiles(flow.solution.field);
  profiles.header = flow.asked.flow_case.profile_header(flow.solution.field);
  profiles.header.side = RunSide::continuum;
  profiles.header.title = flow.asked.scene.title;
  profiles.header.geometry = flow.asked.flow_case.geometry;
  profiles.header.reduced = flow.asked.reduced();
  profiles.header.position = 0;
  profiles.header.layer_thickness = flow.asked.scene.output.layer_thickness;
  profiles.header.diameter_m = scales_of(flow.asked.scene).length_m;
  profiles.header.revision = provenance().revision;
  continuum::add_band(flow.law_band, profiles);
  return profiles;
}

FieldMap maps_with_header(const FinishedFlow& flow, const ProfileSet& profiles) {
  FieldMap maps = continuum::flow_map(flow.solution.field, flow.asked.flow_case.map_area(flow.solution.field),
                                      flow.asked.scene.output.map_spacing);
  maps.scales = scales_of(flow.asked.scene);
  // The grid of the map has the geometry; all else is that of the profiles.
  const RunHeader of_grid = maps.header;
  maps.header = header_of_maps(profiles.header);
  for (const HeaderNumber number : {&RunHeader::axis_depth, &RunHeader::drum_radius, &RunHeader::inner_radius,
                                    &RunHeader::outer_radius, &RunHeader::gap})
    if (of_grid.*number) maps.header.*number = of_grid.*number;
  continuum::add_band(flow.law_band, maps);
  return maps;
}

std::string slope_text(const continuum::IterationReport& line) {
  const auto slope = continuum::slope_of(line);
  return slope ? fmt::format("{:.6f}", *slope * 180 / std::numbers::pi) : "";
}

}  // namespace

void write_iterations(const fs::path& file, const continuum::FlowReport& report) {
  std::string text = fmt::format("# drumlin-flow-iterations-2\n# converged = {}\n", report.converged);
  if (!report.failure.empty()) text += fmt::format("# failure = {}\n", report.failure);
  text +=
      "mesh,phase,shear_rate,iteration,residual,step_length,step_size,linear_residual,theta_"
      "deg,seconds\n";
  for (const continuum::IterationReport& line : report.history)
    fmt::format_to(std::back_inserter(text), "{},{},{:.4g},{},{:.4e},{:.4g},{:.4e},{:.2e},{},{:.2f}\n",
                   line.level, line.phase, line.shear_rate, line.iteration, line.residual, line.step_length,
                   line.step_size, line.linear_residual, slope_text(line), line.seconds);
  replace_file(file, text);
}

void write_flow(const fs::path& folder, const FinishedFlow& flow) {
  const ProfileSet profiles = profiles_with_header(flow);
  const FieldMap maps = maps_with_header(flow, profiles);
  flow.solution.field.write_vtu(folder / "flow.vtu", scales_of(flow.asked.scene));
  const Json content = flow_json(flow);
  const continuum::FlowState state = flow.solution.field.state();
  if (!flow.solution.field.on_first_rank()) return;
  write_profiles(folder / "profiles.csv", profiles);
  write_field_map(folder / "maps.h5", maps);
  continuum::write_flow_state(folder / "state.h5", state);
  // The figures read it under another name: flow.json itself says that all is there.
  const UnfinishedFile unfinished(folder / "flow.json.part");
  write_json(unfinished.path(), content);
  if (flow.asked.scene.output.figures)
    draw_figures("flow_figures.py", {folder.string(), unfinished.path().filename().string()});
  write_json(folder / "flow.json", content);
}

}  // namespace drumlin::apps
