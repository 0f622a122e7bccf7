#include "continuum/io/region_state_file.hpp"

#include <limits>

#include "coupling/core/hdf5/h5_reader.hpp"
#include "coupling/core/hdf5/h5_writer.hpp"

namespace drumlin::continuum {
namespace {

const std::string format = "drumlin-flow-frame-2";
constexpr std::int64_t most = std::numeric_limits<int>::max();

// The numbers of a state and its step, in the order of the file.
template <class Kept, class Visit>
void each_number(Kept& kept, Visit visit) {
  auto& [state, step, scene, law] = kept;
  auto& totals = state.totals;
  for (auto* number :
       {&state.time, &state.area, &state.discharged, &state.kinetic_energy, &totals.fill, &totals.weight_work,
        &totals.energy_error, &totals.mass_error, &step.time_step, &step.discharge_rate, &step.fastest})
    visit(*number);
}

std::vector<double> flat(const std::vector<Vec2>& points) {
  std::vector<double> all;
  for (const Vec2& x : points) all.insert(all.end(), {x.x, x.z});
  return all;
}
std::vector<Vec2> points_of(const std::vector<double>& all) {
  std::vector<Vec2> points;
  for (std::size_t i = 0; i + 1 < all.size(); i += 2) points.push_back({all[i], all[i + 1]});
  return points;
}

}  // namespace

void write_region_state(const std::filesystem::path& file, const KeptRegion& kept) {
  const RegionMesh& mesh = kept.state.mesh;
  std::vector<std::int32_t> triangles, boundary;
  for (const auto& triangle : mesh.triangles)
    triangles.insert(triangles.end(), triangle.begin(), triangle.end());
  for (const auto& edge : mesh.boundary)
    boundary.insert(boundary.end(),
                    {static_cast<std::int32_t>(edge.from), static_cast<std::int32_t>(edge.to), edge.part});
  std::vector<double> numbers;
  each_number(kept, [&](double number) { numbers.push_back(number); });
  H5Writer out;
  out.add_text("format", format);
  out.add_text("scene", kept.scene);
  out.add_text("law", kept.law);
  out.add_number("steps", static_cast<std::int64_t>(kept.state.steps));
  out.add_number("steps_on_mesh", static_cast<std::int64_t>(kept.state.steps_on_mesh));
  out.add_number("iterations", static_cast<std::int64_t>(kept.state.totals.iterations));
  out.add("numbers", numbers,
          {"d, sqrt(d/g), rho0 g d",
           "time, area, discharged, kinetic energy; area of the fill, work of the weight, errors of "
           "energy and mass; of the last step: its length, rate of discharge, largest speed"});
  out.add_table("vertices", flat(mesh.vertices), 2, {"d", "x, z of the corners of the triangles"});
  out.add("triangles", triangles, {"1", "three corners each, anticlockwise"});
  out.add("boundary", boundary, {"1", "sides: from, to, part (walls, then openings; -1: free)"});
  out.add("values", kept.state.values, {"sqrt(g d), rho0 g d", "unknowns in deal.II's order"});
  out.add("rates", kept.state.rates, {"rho0 g d, sqrt(d/g)", "what they change by; empty: unknown"});
  out.add_table("corner_rates", flat(kept.state.corner_rates), 2,
                {"sqrt(g d)", "of vertices; empty: unknown"});
  out.add_table("loads", flat(kept.step.loads), 2, {"rho0 g d^2", "force on each part, along x, z"});
  out.save(file);
}

KeptRegion read_region_state(const std::filesystem::path& file) {
  const H5Reader in(file);
  in.require_format(format);
  KeptRegion kept{{}, {}, in.text("scene"), in.text("law")};
  kept.state.steps = static_cast<int>(in.integer("steps", 0, most));
  kept.state.steps_on_mesh = static_cast<int>(in.integer("steps_on_mesh", 0, most));
  kept.state.totals.iterations = static_cast<int>(in.integer("iterations", 0, most));
  const std::vector<double> numbers = in.doubles("numbers", H5Range::finite);
  std::size_t count = 0;
  each_number(kept, [&](double& number) { number = count < numbers.size() ? numbers[count] : 0, ++count; });
  if (count != numbers.size()) in.refuse("numbers", "another count of numbers");
  RegionMesh& mesh = kept.state.mesh;
  mesh.vertices = points_of(in.doubles("vertices", H5Range::finite));
  const auto corners = static_cast<std::int32_t>(mesh.vertices.size()) - 1;
  const std::vector<std::int32_t> triangles = in.ints("triangles", 0, corners);
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3)
    mesh.triangles.push_back({static_cast<unsigned>(triangles[i]), static_cast<unsigned>(triangles[i + 1]),
                              static_cast<unsigned>(triangles[i + 2])});
  const std::vector<std::int32_t> boundary =
      in.ints("boundary", -1, std::numeric_limits<std::int32_t>::max());
  for (std::size_t i = 0; i + 2 < boundary.size(); i += 3) {
    if (boundary[i] < 0 || boundary[i] > corners || boundary[i + 1] < 0 || boundary[i + 1] > corners)
      in.refuse("boundary", "a side without corners");
    mesh.boundary.push_back(
        {static_cast<unsigned>(boundary[i]), static_cast<unsigned>(boundary[i + 1]), boundary[i + 2]});
  }
  if (mesh.triangles.empty() || mesh.boundary.empty()) in.refuse("triangles", "none");
  kept.state.values = in.doubles("values", H5Range::finite);
  kept.state.rates = in.doubles("rates", H5Range::finite);
  kept.state.corner_rates = points_of(in.doubles("corner_rates", H5Range::finite));
  if (const auto& rates = kept.state.rates;
      !rates.empty() &&
      (rates.size() != kept.state.values.size() || kept.state.corner_rates.size() != mesh.vertices.size()))
    in.refuse("rates", "another count of unknowns or corners");
  kept.step.loads = points_of(in.doubles("loads", H5Range::finite));
  kept.step.step = kept.state.steps;
  kept.step.time = kept.state.time;
  return kept;
}

}  // namespace drumlin::continuum
