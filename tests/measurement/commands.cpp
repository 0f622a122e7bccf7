// drumlin measure and drumlin calibrate on run folders made here.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/commands/calibrate/calibrate.hpp"
#include "apps/commands/measure/measure.hpp"
#include "apps/output/pending_figures.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/text_file.hpp"
#include "coupling/core/hdf5/field_map_file.hpp"
#include "coupling/core/hdf5/h5_reader.hpp"
#include "coupling/core/law/rheology_file.hpp"
#include "coupling/core/results/scalar_set.hpp"
#include "particles/io/snapshot_file.hpp"
#include "tests/comparison/run_folders.hpp"
#include "tests/files/folder.hpp"
#include "tests/measurement/packings.hpp"
#include "tests/support/signed_folder.hpp"

namespace drumlin::apps {
using namespace coupling;
using namespace particles;
namespace {

namespace fs = std::filesystem;
using drumlin::testing::message_of;
using drumlin::testing::TemporaryFolder;

constexpr const char* log_text =
    "step,time_s,stage,residual,overlap_mean,overlap_max\n1,0.5,turn,0.01,1e-4,1e-3\n2,1,turn,0.02,2e-4,2e-"
    "3\n";

fs::path run_folder(const TemporaryFolder& folder, const std::string& status,
                    const std::vector<Snapshot>& snapshots) {
  const fs::path run = folder / "run";
  fs::create_directories(run / "snapshots");
  replace_file(run / "run.json",
               R"({"format": "drumlin-run-1", "reduced": true, "seed": 3, "status": ")" + status + "\"}");
  replace_file(run / "log.csv", log_text);
  for (std::size_t s = 0; s < snapshots.size(); ++s)
    write_snapshot(run / "snapshots" / ("00000" + std::to_string(s) + ".h5"), snapshots[s]);
  drumlin::testing::sign(run, "run", status == "finished");
  return run;
}

Snapshot with_scales(Snapshot snapshot) {
  snapshot.scales = {3.3e-3, 0.018, 2700};
  return snapshot;
}

Snapshot small_columns() { return with_scales(drumlin::testing::stacked_columns(6, 12, 0.2)); }

nlohmann::json measured_json(const fs::path& run) {
  return nlohmann::json::parse(file_text(run / "measured" / "measured.json"));
}

MeasureOptions options_for(const fs::path& run, ExistingOutput existing = ExistingOutput::refuse) {
  MeasureOptions options;
  options.runs = {run};
  options.existing = existing;
  return options;
}

TEST(MeasureCommand, LeavesProfilesScalarsAndFigures) {
  const TemporaryFolder folder;
  const Snapshot drum = with_scales(drumlin::testing::filled_drum(30, 2, 0.35, 0.02));
  const fs::path run = run_folder(folder, "finished", {drum, drum, drum});
  EXPECT_EQ(measure(options_for(run)), 0);
  const ScalarSet scalars = read_scalars(run / "measured" / "measured.json", "drumlin-measured-1");
  for (const char* name : {"theta_deg", "theta_com_deg", "Q", "H", "lambda", "shear_rate", "I_th", "nu_bulk",
                           "spin_over_half_vorticity", "dv_over_shear", "domega_over_shear", "mu_a", "mu_b",
                           "k_flowing", "overlap_mean", "overlap_max", "residual_mean", "Q_expected"})
    EXPECT_NE(scalars.find(name), nullptr) << name;
  EXPECT_NEAR(scalars.value("residual_mean"), 0.015, 1e-12);
  EXPECT_NEAR(scalars.value("Q"), 0, 1e-9);
  EXPECT_TRUE(std::isnan(scalars.value("H")));  // nothing flows: not measured, and not 0
  const auto json = measured_json(run);
  EXPECT_TRUE(json["H"]["value"].is_null());
  EXPECT_EQ(json["reduced"], true);
  const ProfileSet profiles = read_profiles(run / "measured" / "profiles.csv");
  EXPECT_EQ(profiles.header.reduced, true);
  EXPECT_EQ(profiles.header.drum_radius, 30);
  for (const char* figure : {"velocity", "packing", "rotation", "stresses", "rheology", "fluctuations"})
    EXPECT_TRUE(fs::exists(run / "measured" / (figure + std::string(".png")))) << figure;
}

TEST(MeasureCommand, MapsStandOnTheHeightsOfTheProfiles) {
  const TemporaryFolder folder;
  const Snapshot columns = with_scales(drumlin::testing::stacked_columns(8, 14, 0.2));
  const fs::path run = run_folder(folder, "finished", {columns, columns});
  MeasureOptions options = options_for(run);
  options.parts = {"maps"};
  EXPECT_EQ(measure(options), 0);
  const FieldMap map = read_field_map(run / "measured" / "maps.h5");
  const ProfileSet profiles = read_profiles(run / "measured" / "profiles.csv");
  EXPECT_EQ(map.header.side, RunSide::particles);
  EXPECT_EQ(map.header.theta_deg, profiles.header.theta_deg);
  EXPECT_EQ(map.header.kernel_width, 1);
  EXPECT_EQ(map.scales.time_s, 0.018);
  EXPECT_EQ(map.grid.columns, 8u);
  const double rows = (profiles.z.front() - map.grid.z_first) / map.grid.spacing_z;
  EXPECT_NEAR(rows, std::round(rows), 1e-9);
  // Well inside, layers and kernel see the same weight above.
  const auto row = static_cast<std::size_t>(std::round(rows)) + 6;
  EXPECT_NEAR(map.field("sigma_zz").value[row * 8], profiles.column("sigma_zz").value[6], 2e-3);
  const auto json = measured_json(run);
  EXPECT_NEAR(json.at("momentum_balance").at("bulk").at("rms_z").get<double>(), 0, 1e-9);
  EXPECT_TRUE(json.at("mu_invariant").at("a").at("value").is_null());  // nothing moves: no I to fit over
  EXPECT_TRUE(fs::exists(run / "measured" / "maps.png"));

  options.existing = ExistingOutput::overwrite;
  options.map_width = 0.5;
  EXPECT_NE(message_of<InputError>([&] { measure(options); }).find("width"), std::string::npos);
}

TEST(MeasureCommand, MeasuresForcesWhereContactsCarryAny) {
  const TemporaryFolder folder;
  const Snapshot packing = small_columns();
  const fs::path run = run_folder(folder, "finished", std::vector<Snapshot>(5, packing));
  MeasureOptions options = options_for(run);
  options.parts = {"forces"};
  EXPECT_EQ(measure(options), 0);
  const ProfileSet layers = read_profiles(run / "measured" / "forces.csv");
  EXPECT_EQ(layers.column("contacts").value.front(), 30);  // six on the lowest row, five snapshots
  const auto json = measured_json(run);
  const auto wall = json.at("forces").at("zones").at("wall");
  EXPECT_NEAR(wall.at("f_t_over_f_n").at("value").get<double>(), std::tan(0.2), 1e-6);
  EXPECT_FALSE(wall.contains("sliding_share"));  // without a scene the friction is not known
  EXPECT_TRUE(fs::exists(run / "measured" / "force_distributions.csv"));
  EXPECT_TRUE(fs::exists(run / "measured" / "forces.png"));

  fs::remove_all(run / "snapshots");
  const Snapshot loose = with_scales(drumlin::testing::hexagonal_layer(6, 6));
  run_folder(folder, "finished", {loose});
  options.existing = ExistingOutput::overwrite;
  EXPECT_EQ(measure(options), 0);
  EXPECT_TRUE(measured_json(run)["forces"].is_null());
  EXPECT_FALSE(fs::exists(run / "measured" / "forces.csv"));
}

TEST(MeasureCommand, RefusesSlicesInOnePlaceOrNowhere) {
  const TemporaryFolder folder;
  const Snapshot drum = with_scales(drumlin::testing::filled_drum(30, 2, 0.35, 0.02));
  MeasureOptions options = options_for(run_folder(folder, "finished", {drum, drum, drum}));
  for (const std::vector<double>& slices : {std::vector{1.21, 1.24}, {std::nan("")}, {1e300}}) {
    options.slices = slices;
    EXPECT_THROW((void)measure(options), InputError);
    EXPECT_FALSE(fs::exists(options.run() / "measured"));
  }
}

// That a script which fails is named and costs the others nothing: PendingFigures in tests/files.
TEST(MeasureCommand, FiguresThatAreMissingAreDrawnAgainAndCostNoNumber) {
  const TemporaryFolder folder;
  const fs::path run = run_folder(folder, "finished", std::vector<Snapshot>(5, small_columns()));
  const fs::path results = run / "measured";
  MeasureOptions options = options_for(run);
  options.parts = {"forces"};
  ASSERT_EQ(measure(options), 0);
  const auto json = nlohmann::json::parse(file_text(results / "measured.json"));
  for (const char* key : {"theta_deg", "forces", "settings", "accuracy", "seconds"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_FALSE(read_profiles(results / "profiles.csv").z.empty());
  EXPECT_FALSE(read_profiles(results / "forces.csv").z.empty());
  EXPECT_TRUE(fs::exists(results / "forces.png"));

  // As a script that failed leaves it.
  fs::remove(results / "velocity.png");
  note_pending_figures(results);
  drumlin::testing::sign(results, "measure");
  const std::string profiles = file_text(results / "profiles.csv");
  options.existing = ExistingOutput::resume;
  EXPECT_EQ(measure(options), 0);
  EXPECT_TRUE(fs::exists(results / "velocity.png"));
  EXPECT_EQ(file_text(results / "profiles.csv"), profiles);
}

TEST(MeasureCommand, RefusesWhatIsNoFinishedRun) {
  const TemporaryFolder folder;
  const fs::path run = run_folder(folder, "running", {small_columns()});
  EXPECT_NE(message_of<InputError>([&] { measure(options_for(run)); }).find("unfinished"), std::string::npos);
  EXPECT_FALSE(fs::exists(run / "measured"));
  EXPECT_THROW(measure(options_for(folder / "nowhere")), InputError);
  EXPECT_THROW(measure(options_for(folder.path())), InputError);
  const fs::path empty = run_folder(folder, "finished", {});
  fs::remove_all(empty / "snapshots");
  EXPECT_NE(message_of<InputError>([&] { measure(options_for(empty)); }).find("is missing"),
            std::string::npos);
  drumlin::testing::sign(empty, "run");
  EXPECT_NE(message_of<InputError>([&] { measure(options_for(empty)); }).find("no snapshots"),
            std::string::npos);
}

TEST(MeasureCommand, WritesTheFieldsOfEveryGrainOfTheSnapshotsAskedFor) {
  const TemporaryFolder folder;
  std::vector<Snapshot> snapshots(3, small_columns());
  for (std::size_t s = 0; s < 3; ++s) snapshots[s].step = static_cast<std::int64_t>(100 + s);
  const fs::path run = run_folder(folder, "finished", snapshots);
  MeasureOptions options = options_for(run);
  options.parts = {"none"};
  options.grains = "3";
  EXPECT_NE(message_of<InputError>([&] { measure(options); }).find("--grains: '3' is not there"),
            std::string::npos);
  EXPECT_FALSE(fs::exists(run / "measured" / "measured.json"));
  options.grains = "0,2";
  options.existing = ExistingOutput::resume;
  EXPECT_EQ(measure(options), 0);
  const fs::path grains = run / "measured" / "grains";
  EXPECT_FALSE(fs::exists(grains / "000001.h5"));
  EXPECT_TRUE(fs::exists(grains / "000000.h5"));
  EXPECT_TRUE(fs::exists(run / "measured" / "grains.png"));
  const H5Reader file(grains / "000002.h5");
  EXPECT_EQ(file.text("format"), "drumlin-grains-1");
  EXPECT_EQ(file.integer("step"), 102);
  const auto nu = file.floats("grains/nu"), sigma_zz = file.floats("grains/sigma_zz_contact"),
             z = file.floats("grains/z"), kinetic = file.floats("grains/sigma_xx_kinetic");
  ASSERT_EQ(nu.size(), 72u);
  EXPECT_NEAR(nu[5], std::numbers::pi / 4, 1e-6);
  EXPECT_NEAR(sigma_zz[5], std::numbers::pi / 4 * 6.5 * std::cos(0.2), 1e-5);
  EXPECT_LT(z[0], -10);      // from the surface
  EXPECT_EQ(kinetic[5], 0);  // eighteen grains at rest stand behind the mean
}

using drumlin::testing::column_of;
using drumlin::testing::example_measured;
using drumlin::testing::example_profiles;
using drumlin::testing::Json;
using drumlin::testing::measured_folder;

/// A measured run whose layers lie on mu = 0.36 + b ln I.
fs::path measured_run(const TemporaryFolder& folder, const std::string& name, double b,
                      double rotation = 0.0115) {
  ProfileSet profiles = example_profiles();
  profiles.header.rotation = rotation;
  ProfileColumn &I = column_of(profiles, "I"), &mu = column_of(profiles, "mu");
  for (std::size_t l = 0; l < profiles.z.size(); ++l) {
    I.value[l] = 0.12 * std::exp(profiles.z[l] / 5);
    I.ci99[l] = 0.1 * I.value[l];
    mu.value[l] = 0.36 + b * std::log(I.value[l]) + (l % 2 == 0 ? 0.01 : -0.01);
    mu.ci99[l] = 0.005;
  }
  Json measured = example_measured();
  measured["nu_bulk"] = {{"value", 0.82}, {"ci99", 0.002}};
  measured["settings"]["rotation"] = rotation;
  return measured_folder(folder, name, profiles, measured);
}

TEST(CalibrateCommand, LeavesTheLawOfItsRuns) {
  const TemporaryFolder folder;
  CalibrateOptions options;
  options.runs = {measured_run(folder, "six", 0.0144), measured_run(folder, "ten", 0.0144, 0.019)};
  options.validate = {measured_run(folder, "five", 0.0144, 0.0096)};
  options.law = "log";
  options.output = folder / "rheology.toml";
  EXPECT_EQ(calibrate(options), 0);
  const RheologyFit fit = read_rheology(options.output);
  const auto mu = std::get<LogLaw>(fit.mu);
  EXPECT_NEAR(mu.a, 0.36, 0.003);  // 35 layers off the law by 0.01 to either side in turn
  EXPECT_NEAR(mu.b, 0.0144, 0.0005);
  EXPECT_GT(mu.covariance[0], 0);
  EXPECT_EQ(fit.draws.size(), 16u);
  EXPECT_NEAR(*fit.rms_misfit, 0.01, 0.0005);
  EXPECT_GT(mu.I_min, 1e-4);
  EXPECT_LT(mu.I_max, 0.1);
  EXPECT_NEAR(fit.nu, 0.82, 1e-12);
  EXPECT_NEAR(*fit.nu_ci99, 0.002 / std::sqrt(2.0), 1e-12);
  EXPECT_EQ(fit.fitted_on, (std::vector<std::string>{"six", "ten"}));
  EXPECT_TRUE(fs::exists(folder / "rheology.png"));
  const Json record = Json::parse(file_text(folder / "rheology.json"));
  EXPECT_EQ(record["forms"].size(), 4u);  // every form is scored, one is chosen
  EXPECT_TRUE(record["well_posed"].get<bool>());
  EXPECT_TRUE(record["one_law"]["holds"].get<bool>());
  EXPECT_NEAR(record["held_out"][0]["bias"].get<double>(), 0, 0.003);
  EXPECT_THROW(calibrate(options), InputError);  // the law exists
}

TEST(CalibrateCommand, RefusesWhatItCannotUse) {
  const TemporaryFolder folder;
  CalibrateOptions options;
  options.runs = {measured_run(folder, "six", 0.0144)};
  options.output = folder / "rheology.toml";
  options.from = "maps";
  EXPECT_NE(message_of<InputError>([&] { calibrate(options); }).find("--parts maps"), std::string::npos);
  options.from = "auto";
  options.misalignment = true;
  EXPECT_THROW(calibrate(options), InputError);
  options.misalignment = false;
  Json unsteady = example_measured();
  unsteady["nu_bulk"] = {{"value", 0.82}, {"ci99", 0.002}};
  unsteady["steadiness"] = {{"steady", false}, {"reasons", {"the slope falls"}}};
  options.validate = {measured_folder(folder, "falling", example_profiles(), unsteady)};
  EXPECT_NE(message_of<InputError>([&] { calibrate(options); }).find("the slope falls"), std::string::npos);
  Json other = example_measured();
  other["settings"]["scales"]["density_kg_m3"] = 1000.0;
  options.validate = {measured_folder(folder, "light", example_profiles(), other)};
  EXPECT_THROW(calibrate(options), InputError);
  EXPECT_FALSE(fs::exists(options.output));
}

}  // namespace
}  // namespace drumlin::apps
