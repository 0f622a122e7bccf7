#include "apps/commands/score_fields.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/json/json_file.hpp"
#include "apps/output/figures.hpp"
#include "coupling/comparison/map_sampling.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/hdf5/field_map_file.hpp"
#include "coupling/core/results/plane_invariants.hpp"
#include "coupling/core/results/run_records.hpp"
#include "particles/measurement/frame/measurement_frame.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;

/// Adds what a comparison reads beside velocity, its gradient and stress.
void add_invariants(FieldMap& map) {
  constexpr std::array wanted{std::pair{"strain_rate", &PlaneInvariants::strain_rate},
                              std::pair{"half_vorticity", &PlaneInvariants::half_vorticity},
                              std::pair{"p", &PlaneInvariants::p},
                              std::pair{"I", &PlaneInvariants::I},
                              std::pair{"mu", &PlaneInvariants::mu},
                              std::pair{"k", &PlaneInvariants::k},
                              std::pair{"axis_angle_deg", &PlaneInvariants::axis_angle_deg}};
  std::array<MapField, wanted.size()> found;
  const auto values = [&](const char* name) { return map.field(name).value; };
  const auto xx = values("sigma_xx"), zz = values("sigma_zz"), xz = values("sigma_xz");
  const auto xx_rate = values("d_v_x_dx"), xz_rate = values("d_v_x_dz"), zx_rate = values("d_v_z_dx"),
             zz_rate = values("d_v_z_dz");
  for (std::size_t i = 0; i < map.grid.nodes(); ++i) {
    const PlaneInvariants at =
        plane_invariants({xx[i], -xz[i], -xz[i], zz[i]}, {xx_rate[i], xz_rate[i], zx_rate[i], zz_rate[i]});
    for (std::size_t k = 0; k < wanted.size(); ++k) found[k].value.push_back(at.*wanted[k].second);
  }
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    found[k].name = wanted[k].first;
    if (map.find(found[k].name) == nullptr) map.fields.push_back(std::move(found[k]));
  }
}

/// The layers below the middle of the surface that the map covers.
ProfileSet middle_of(const FieldMap& map) {
  const particles::MeasurementOptions usual;
  const double thickness = usual.layer_thickness;
  std::vector<double> z;
  for (double at = std::floor(map.grid.z_first) + 0.5; at < 0; at += thickness) z.push_back(at);
  ProfileSet all = coupling::profile_through(map, 0, usual.slice_width, z, thickness);
  std::vector<std::size_t> known;
  for (std::size_t i = 0; i < z.size(); ++i)
    if (std::isfinite(all.column("v_x").value[i] * all.column("sigma_xz").value[i])) known.push_back(i);
  if (known.empty())
    throw InputError("the fields hold nothing below the middle of the surface (allowed: a drum)");
  const auto cut = [&](std::vector<double>& values) {
    values = {values.begin() + static_cast<std::ptrdiff_t>(known.front()),
              values.begin() + static_cast<std::ptrdiff_t>(known.back() + 1)};
  };
  cut(all.z);
  for (ProfileColumn& column : all.columns) cut(column.value), column.ci99.clear();
  all.header.wall_z = all.z.front() - thickness / 2;
  return all;
}

bool holds_profiles(const fs::path& file) { return file_text(file).starts_with("# drumlin-profiles-1"); }

}  // namespace

void write_flow_of_fields(const fs::path& file, const fs::path& folder) {
  make_folders(folder);
  const fs::path maps = folder / "maps.h5";
  const bool is_csv = file.extension() == ".csv";
  if (!is_csv && file.extension() != ".h5")
    throw InputError(file.string() + ": is no file of fields (allowed: a folder of drumlin flow, .h5, .csv)");
  ProfileSet profiles;
  Scales scales;
  if (is_csv && holds_profiles(file)) {
    profiles = read_profiles(file);
    const double d = needed_number(profiles.header, &RunHeader::diameter_m, file.string());
    scales = scales_of(d, 0, 1);  // of the density a profile says nothing, and no error depends on it
  } else {
    if (is_csv) (void)output_of_script("../study/fields.py", {file.string(), maps.string()});
    FieldMap map = read_field_map(is_csv ? maps : file);
    add_invariants(map);
    write_field_map(maps, map);
    profiles = middle_of(map);
    scales = map.scales;
  }
  if (profiles.header.side != RunSide::continuum)
    throw InputError({InputProblem{file.string(), 0, 0, "side", "is not that of a continuum", "continuum"}});
  write_profiles(folder / "profiles.csv", profiles);
  replace_file(folder / "flow_scene.toml", "[effects]\n");
  const double theta = needed_number(profiles.header, &RunHeader::theta_deg, file.string());
  write_json(folder / "flow.json", {{"format", FlowRecord::format},
                                    {"geometry", "drum"},
                                    {"reduced", profiles.header.reduced.value_or(false)},
                                    {"theta_deg", theta},
                                    {"settings", {{"scales", scales}}}});
}

}  // namespace drumlin::apps
