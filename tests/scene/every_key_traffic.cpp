// Cases for the keys of outlets, sources, groups of grains and grains of other runs.
#include "tests/scene/every_key_cases.hpp"

namespace drumlin::testing {
namespace {

const std::string circle = "shape = \"circle\"", rectangle = "shape = \"rectangle\"";
const std::string box_low = "{shape=\"rectangle\", min_mm=[-9, -1], max_mm=[0, 3]}";
const std::string disc_low = "{shape=\"circle\", center_mm=[-4, 2], radius_mm=4}";
const std::string far_up = "grains.generated.region={shape=\"rectangle\", min_mm=[-8, 30], max_mm=[8, 50]}";
const std::string listed_group = "grains.groups=[{name=\"more\", listed={file=\"two.csv\"}}]";
const std::string box_middle = "{shape=\"rectangle\", min_mm=[-9, 5], max_mm=[9, 15]}";
const std::string box_high = "{shape=\"rectangle\", min_mm=[-9, 20], max_mm=[9, 30]}";
const std::string disc_high = "{shape=\"circle\", center_mm=[0, 26], radius_mm=6}";

std::string outlet(const std::string& region, const std::string& more = "") {
  return "outlets=[{name=\"out\", region=" + region + more + "}]";
}
std::string returning(const std::string& region) { return outlet(box_low, ", returns_to=" + region); }
std::string source(const std::string& region, const std::string& more = "") {
  return "sources=[{name=\"rain\", region=" + region +
         ", grains_per_s=100, diameter_min_mm=0.8, diameter_max_mm=1.2" + more + "}]";
}
std::string group(const std::string& region, const std::string& more = "") {
  return "grains.groups=[{name=\"more\", generated={count=5, diameter_min_mm=0.8, diameter_max_mm=1.2, "
         "region=" +
         region + more + "}}]";
}

/// The keys of a region: `made` is a whole override with the region given, `key` as listed, `name` as
/// overridden.
void add_region(std::vector<Case>& all, const std::string& key, const std::string& name,
                std::string (*made)(const std::string&), const std::string& box, const std::string& disc,
                const std::vector<std::string>& corners, const std::vector<std::string>& of_disc) {
  const std::string* F = &floor_scene();
  all.push_back({key + ".shape", "", F, {made(box)}, made(disc), positions_mm});
  all.push_back({key + ".min_mm", rectangle, F, {made(box)}, name + ".min_mm=" + corners[0], positions_mm});
  all.push_back({key + ".max_mm", rectangle, F, {made(box)}, name + ".max_mm=" + corners[1], positions_mm});
  all.push_back(
      {key + ".center_mm", circle, F, {made(disc)}, name + ".center_mm=" + of_disc[0], positions_mm});
  all.push_back(
      {key + ".radius_mm", circle, F, {made(disc)}, name + ".radius_mm=" + of_disc[1], positions_mm});
}

/// The keys of a distribution of sizes behind `key`.
void add_sizes(std::vector<Case>& all, const std::string& key, const std::string& name,
               std::string (*made)(const std::string&)) {
  const std::string* F = &floor_scene();
  const std::string two = made(", sizes={kind=\"two\", small_share=0.6}");
  const std::string power = made(", sizes={kind=\"power_law\", exponent=3}");
  const std::string lognormal = made(", sizes={kind=\"lognormal\", median_mm=1, sigma=0.2}");
  all.push_back({key, "", F, {made("")}, two, positions_mm});
  all.push_back({key + ".kind", "", F, {two}, power, positions_mm});
  all.push_back({key + ".small_share", "kind = \"two\"", F, {two}, name + ".small_share=1", kinetic_energy});
  all.push_back({key + ".exponent", "kind = \"power_law\"", F, {power}, name + ".exponent=9", positions_mm});
  all.push_back(
      {key + ".median_mm", "kind = \"lognormal\"", F, {lognormal}, name + ".median_mm=0.9", positions_mm});
  all.push_back({key + ".sigma", "kind = \"lognormal\"", F, {lognormal}, name + ".sigma=0.01", positions_mm});
  for (const auto& [kind, sized] :
       {std::pair("two", two), std::pair("power_law", power), std::pair("lognormal", lognormal)})
    all.push_back({key + ".by",
                   "kind = \"" + std::string(kind) + "\"",
                   F,
                   {sized},
                   name + ".by=\"mass\"",
                   kinetic_energy});
  const std::string sieve =
      made(", sizes={kind=\"sieve\", openings_mm=[0.9, 1.1], passing_share=[0.2, 0.5]}");
  all.push_back(
      {key + ".openings_mm", "kind = \"sieve\"", F, {sieve}, name + ".openings_mm=[1, 1.1]", kinetic_energy});
  all.push_back({key + ".passing_share",
                 "kind = \"sieve\"",
                 F,
                 {sieve},
                 name + ".passing_share=[0.8, 0.9]",
                 kinetic_energy});
}

std::string plain_outlet(const std::string& region) { return outlet(region); }
std::string plain_source(const std::string& region) { return source(region); }
std::string plain_group(const std::string& region) { return group(region); }
std::string sized_source(const std::string& sizes) { return source(box_high, sizes); }
std::string sized_group(const std::string& sizes) { return group(box_high, sizes); }

}  // namespace

std::vector<Case> cases_of_traffic() {
  const std::string* F = &floor_scene();
  const std::string out = outlet(box_low), rain = source(box_high);
  std::vector<Case> all = {
      {"outlets[]", "", F, {}, out, positions_mm},
      {"outlets[].name", "", F, {returning(box_high)}, "outlets.0.name=hole", positions_mm},
      {"outlets[].region", "", F, {out}, "outlets.0.region=" + disc_low, positions_mm},
      {"outlets[].returns_to", "", F, {out}, returning(box_high), positions_mm},
      {"outlets[].return_velocity_mm_s",
       "",
       F,
       {returning(box_high)},
       "outlets.0.return_velocity_mm_s=[9, 9]",
       positions_mm},
      {"stages[].until.out",
       "",
       F,
       {out, "stages.0.until={moved={wall=\"right\", distance_mm=1}}"},
       "stages.0.until.out={outlet=\"out\", count=1}",
       steps},
      {"stages[].until.out.outlet",
       "",
       F,
       {out, "stages.0.until.out={outlet=\"out\", count=1}"},
       "stages.0.until.out.outlet=other",
       exit_code},
      {"stages[].until.out.count",
       "",
       F,
       {out, "stages.0.until.out={outlet=\"out\", count=1}"},
       "stages.0.until.out.count=1000",
       steps},
      {"sources[]", "", F, {}, rain, positions_mm},
      {"sources[].name", "", F, {rain}, "sources.0.name=snow", positions_mm},
      {"sources[].region", "", F, {rain}, "sources.0.region=" + disc_high, positions_mm},
      {"sources[].grains_per_s", "", F, {rain}, "sources.0.grains_per_s=50", positions_mm},
      {"sources[].count", "", F, {rain}, "sources.0.count=2", positions_mm},
      {"sources[].diameter_min_mm", "", F, {rain}, "sources.0.diameter_min_mm=0.5", positions_mm},
      {"sources[].diameter_max_mm", "", F, {rain}, "sources.0.diameter_max_mm=1.5", positions_mm},
      {"sources[].material", "", F, {rain}, "sources.0.material=none", exit_code},
      {"sources[].density_kg_m3", "", F, {rain}, "sources.0.density_kg_m3=9000", kinetic_energy},
      {"sources[].velocity_mm_s", "", F, {rain}, "sources.0.velocity_mm_s=[5, -50]", positions_mm},
      {"grains.groups[]", "", F, {}, group(box_high), positions_mm},
      {"grains.groups[].name", "", F, {group(box_high)}, "grains.groups.0.name=others", positions_mm},
      {"grains.groups[].material", "", F, {group(box_high)}, "grains.groups.0.material=none", exit_code},
      {"grains.groups[].density_kg_m3",
       "",
       F,
       {group(box_high)},
       "grains.groups.0.density_kg_m3=9000",
       kinetic_energy},
      {"grains.groups[].generated", "", F, {far_up, listed_group}, group(box_middle), positions_mm},
      {"grains.groups[].generated.count",
       "",
       F,
       {group(box_high)},
       "grains.groups.0.generated.count=4",
       positions_mm},
      {"grains.groups[].generated.diameter_min_mm",
       "",
       F,
       {group(box_high)},
       "grains.groups.0.generated.diameter_min_mm=0.5",
       positions_mm},
      {"grains.groups[].generated.diameter_max_mm",
       "",
       F,
       {group(box_high)},
       "grains.groups.0.generated.diameter_max_mm=1.5",
       positions_mm},
      {"grains.groups[].generated.region",
       "",
       F,
       {group(box_high)},
       "grains.groups.0.generated.region=" + disc_high,
       positions_mm},
      {"grains.groups[].generated.around",
       "",
       F,
       {group(box_high), "walls.1.center_mm=[0, 25]"},
       "grains.groups.0.generated.around=[\"left\"]",
       exit_code},
      {"grains.groups[].listed", "", F, {far_up, group(box_middle)}, listed_group, positions_mm},
      {"grains.groups[].listed.file",
       "",
       F,
       {far_up, listed_group},
       "grains.groups.0.listed.file=three.csv",
       positions_mm},
      {"grains.from_run", "", F, {}, "grains={density_kg_m3=2700, from_run={run=\"none\"}}", exit_code},
      {"grains.from_run.run", "", F, {}, "grains={density_kg_m3=2700, from_run={run=\"none\"}}", exit_code},
      {"grains.from_run.time_s",
       "",
       F,
       {},
       "grains={density_kg_m3=2700, from_run={run=\"none\", time_s=1}}",
       exit_code},
  };
  add_region(all, "outlets[].region", "outlets.0.region", plain_outlet, box_low, disc_low,
             {"[-4, -1]", "[-3, 3]"}, {"[4, 2]", "1"});
  add_region(all, "outlets[].returns_to", "outlets.0.returns_to", returning, box_high, disc_high,
             {"[-5, 22]", "[5, 40]"}, {"[1, 30]", "5"});
  add_region(all, "sources[].region", "sources.0.region", plain_source, box_high, disc_high,
             {"[-5, 22]", "[5, 40]"}, {"[1, 30]", "5"});
  add_region(all, "grains.groups[].generated.region", "grains.groups.0.generated.region", plain_group,
             box_high, disc_high, {"[-5, 22]", "[-5, 30]"}, {"[1, 30]", "5"});
  add_sizes(all, "sources[].sizes", "sources.0.sizes", sized_source);
  add_sizes(all, "grains.groups[].generated.sizes", "grains.groups.0.generated.sizes", sized_group);
  all.push_back({"grains.groups[].generated.placement",
                 "",
                 F,
                 {sized_group("")},
                 sized_group(", placement=\"deposited\""),
                 positions_mm});
  return all;
}

}  // namespace drumlin::testing
