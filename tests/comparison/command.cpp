// drumlin compare on folders made here: what it refuses, and what it leaves.
#include <gtest/gtest.h>

#include "apps/commands/compare.hpp"
#include "coupling/comparison/layers.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/hdf5/field_map_file.hpp"
#include "particles/measurement/layers/scalars.hpp"
#include "tests/comparison/example_maps.hpp"
#include "tests/comparison/run_folders.hpp"
#include "tests/comparison/shear_example.hpp"
#include "tests/support/says.hpp"

namespace drumlin::apps {
using namespace coupling;
namespace {

namespace fs = std::filesystem;
using namespace testing;

CompareOptions options_for(const TemporaryFolder& folder, const fs::path& run, const fs::path& flow) {
  CompareOptions options;
  options.run = run;
  options.flow_run = flow;
  options.output = folder / "report";
  return options;
}

/// The command refuses with all these words and writes nothing.
void expect_refused(const TemporaryFolder& folder, const CompareOptions& options,
                    const std::vector<std::string>& words) {
  const std::string said = message_of<InputError>([&] { compare(options); });
  for (const std::string& word : words) expect_has(said, word);
  EXPECT_FALSE(fs::exists(folder / "report")) << said;
}

TEST(CompareCommand, LeavesAReportWithBandsAndFloorAndWhatIsMissingIsNull) {
  const TemporaryFolder folder;
  Json reduced = example_measured();  // spares the figures of costs
  reduced["reduced"] = true;
  ProfileSet particles = example_profiles(), continuum = scaled(continuum_profiles(), "v_x", 1.1),
             other = scaled(example_profiles(), "v_x", 1.02);
  for (ProfileSet* set : {&particles, &continuum, &other}) set->header.reduced = true;

  auto& speed = column_of(continuum, "v_x");
  for (const double value : speed.value) speed.ci99.push_back(0.2 * value);
  Json flow = example_flow();
  flow["reduced"] = true;
  flow["law_band"] = {{"replicates", 50}, {"scalars", {{"H", 0.7}}}};
  CompareOptions options = options_for(folder, measured_folder(folder, "run", particles, reduced),
                                       flow_folder(folder, "flow", continuum, flow));
  options.floor = measured_folder(folder, "seed2", other, reduced);
  EXPECT_EQ(compare(options), 0);
  const Json report = Json::parse(file_text(folder / "report/comparison.json"));
  const Json& errors = report["errors"]["v_x"]["flowing"];
  EXPECT_NEAR(errors["rel_l2"].get<double>(), 0.1, 1e-9);
  EXPECT_NEAR(errors["floor_rel_l2"].get<double>(), 0.02, 1e-9);
  EXPECT_EQ(errors["explained"]["calibration"], 1.0);
  EXPECT_EQ(errors["inside_both_bands"], 1.0);
  EXPECT_EQ(errors["inside_band"], 0.0);
  EXPECT_EQ(report["scalars"]["H"]["continuum"]["ci99"], 0.7);
  EXPECT_TRUE(report["slices"].is_null() && report["slices_missing"].is_string());
  EXPECT_TRUE(report["maps"].is_null() && report["maps_missing"].is_string());
  EXPECT_EQ(report["floor"]["name"], "seed2");
  EXPECT_EQ(report["cost_ratio"]["processor"], 50.0);
  EXPECT_TRUE(fs::exists(folder / "report/overlay.csv") && !fs::exists(folder / "report/figures.pending"));
  expect_has(file_text(folder / "report/index.html"), "data:image/png;base64,");
}

/// Folders of plane shear as `drumlin measure` and `drumlin flow` leave them.
fs::path measured_shear(const TemporaryFolder& folder, const std::string& name) {
  Json measured = example_measured();
  measured["reduced"] = true;
  measured["bulk_mu"] = {{"value", 0.3}, {"ci99", 0.01}};
  measured["settings"] = {{"scales", example_scales()}};
  measured["settings"]["scales"]["length_m"] = 0.002;
  return measured_folder(folder, name, sheared_packing(), measured);
}

Json shear_flow() {
  Json flow = example_flow();
  flow["reduced"] = true;
  flow["geometry"] = "plane_shear";
  flow["settings"] = {{"scales", example_scales()}};
  flow["settings"]["scales"]["length_m"] = 0.002;
  return flow;
}

TEST(CompareCommand, ComparesLayersOfAnyGeometryThatBothSidesShare) {
  const TemporaryFolder folder;
  ProfileSet continuum = scaled(sheared_continuum(), "v_x", 1.2);
  // A flow between plates has neither a drum nor a slope.
  for (const char* key : {"theta_deg", "rotation", "drum_radius"}) erase_entry(continuum.header, key);
  CompareOptions options = options_for(folder, measured_shear(folder, "run"),
                                       flow_folder(folder, "flow", continuum, shear_flow()));
  options.floor = measured_shear(folder, "seed2");
  EXPECT_EQ(compare(options), 0);
  const Json report = Json::parse(file_text(folder / "report/comparison.json"));
  EXPECT_EQ(report["format"], "drumlin-layer-comparison-1");
  EXPECT_EQ(report["geometry"], "plane_shear");
  EXPECT_EQ(report["registration"]["by"], "base");
  EXPECT_NEAR(report["errors"]["v_x"]["bulk"]["rel_l2"].get<double>(), 0.2, 1e-9);
  EXPECT_EQ(report["errors"]["v_x"]["bulk"]["floor_rel_l2"], 0.0);
  EXPECT_EQ(report["scalars"]["bulk_mu"]["particles"]["ci99"], 0.01);
  for (const char* file : {"overlay.csv", "profiles.png", "ratios.png", "law.png"})
    EXPECT_TRUE(fs::exists(folder / "report" / file)) << file;
  EXPECT_FALSE(fs::exists(folder / "report/figures.pending"));
  expect_has(file_text(folder / "report/index.html"), "between two rough plates");
}

TEST(CompareCommand, RefusesSidesThatAreWrongAloneOrTogetherAndWritesNothing) {
  const TemporaryFolder folder;
  const fs::path run = measured_folder(folder, "run"), flow = flow_folder(folder, "flow");
  Json unsteady = example_measured(), dense = example_flow();
  unsteady["steadiness"] = {{"steady", false}, {"reasons", {"half a turn only"}}};
  dense["settings"]["scales"]["density_kg_m3"] = 2500.0;
  expect_refused(folder,
                 options_for(folder, measured_folder(folder, "a", example_profiles(), unsteady), flow),
                 {"half a turn only", "--accept-unsteady"});
  expect_refused(folder, options_for(folder, run, flow_folder(folder, "c", example_profiles())),
                 {"side", "continuum"});
  expect_refused(folder, options_for(folder, run, flow_folder(folder, "units", continuum_profiles(), dense)),
                 {"scales.density_kg_m3", "2700", "2500"});
  expect_refused(folder, options_for(folder, measured_shear(folder, "shear"), flow),
                 {"geometry", "plane_shear", "drum"});
  CompareOptions floor = options_for(folder, run, flow);
  floor.floor = folder / "nowhere";
  expect_refused(folder, floor, {"no such folder"});
  FieldMap map = example_map("continuum");
  map.header.axis_depth = 2;
  write_field_map(flow / "maps.h5", map);
  expect_refused(folder, options_for(folder, run, flow), {"maps.h5", "axis_depth"});
}

TEST(CompareCommand, BulkOfLayersIsThatOfTheMeasurement) {
  const ProfileSet packing = sheared_packing();
  particles::Profile profile{std::vector<particles::LayerValues>(packing.z.size()), {}};
  for (std::size_t l = 0; l < packing.z.size(); ++l) {
    profile.layers[l].z = packing.z[l];
    for (const particles::LayerQuantity& quantity : particles::layer_quantities())
      if (const ProfileColumn* column = packing.find(quantity.name))
        profile.layers[l].*quantity.value = column->value[l];
  }
  const ScalarSet measured = particles::bulk_scalars(profile, *packing.header.wall_z, 4);
  const LayerComparison comparison =
      compare_layers(shear_side(packing), shear_side(packing), Registration::axis);
  int found = 0;
  for (const Scalar& scalar : measured.scalars)
    for (const ScalarPair& pair : comparison.scalars) {
      if (pair.name != scalar.name) continue;
      EXPECT_DOUBLE_EQ(pair.particles, scalar.value) << pair.name;
      ++found;
    }
  EXPECT_EQ(found, 6);
}

}  // namespace
}  // namespace drumlin::apps
