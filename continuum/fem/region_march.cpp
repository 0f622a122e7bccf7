#include "continuum/fem/region_march.hpp"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "continuum/fem/detail/newton.hpp"
#include "continuum/fem/detail/split_triangles.hpp"
#include "continuum/fem/detail/time_step.hpp"
#include "continuum/model/mesh_motion.hpp"
#include "continuum/model/outline.hpp"
#include "continuum/model/part_line.hpp"
#include "continuum/model/region_mesh.hpp"
#include "continuum/model/touch_down.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum {
namespace {

using fem::Discretisation;
using fem::FieldVector;
using fem::SolvedLevel;
using fem::SplitTriangles;
using fem::Work;

constexpr double cells_in_a_step = 0.4;  // that the fastest material passes
constexpr int most_steps_on_a_mesh = 20;
constexpr double poorest_quality = 0.2;
constexpr double place_of_contact = 1e-6;  // d
constexpr double hardly_past = 0.1;        // a wall that moves, sizes: as far as corrections of the area go

std::map<Side, BoundaryCondition> sides_of(const Region& region, double time) {
  std::map<Side, BoundaryCondition> sides;
  for (std::size_t i = 0; i < region.parts.size(); ++i) {
    const RegionPart& part = region.parts[i];
    if (part.kind == RegionPart::Kind::opening && time >= part.begins) continue;
    const auto moves = [region, i, time](Vec2 x) { return wall_velocity(region, i, time, x); };
    auto& side = sides[side_of_part(static_cast<int>(i))];
    if (part.kind == RegionPart::Kind::friction)
      side = FrictionWall{.velocity = moves, .friction = part.friction};
    else
      side = PrescribedVelocity{moves};
  }
  return sides;
}

// Per cell and vertex a corner's value, where the vertex is one.
template <class Visit>
void for_each_corner(const Discretisation& d, std::size_t corners, Visit visit) {
  std::vector<dealii::types::global_dof_index> indices(d.elements.n_dofs_per_cell());
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    cell->get_dof_indices(indices);
    for (const unsigned int v : cell->vertex_indices())
      if (const unsigned int k = cell->vertex_index(v); k < corners) visit(cell, v, k, indices);
  }
}

// Q2's support points begin with the vertices, and an FESystem counts all components of one vertex after the
// other.
std::vector<Vec2> velocity_at_corners(const Discretisation& d, std::size_t corners, const FieldVector& u) {
  std::vector<double> sums(3 * corners, 0.0);
  for_each_corner(d, corners, [&](const auto&, unsigned int v, unsigned int k, const auto& indices) {
    for (unsigned int c = 0; c < 2; ++c)
      sums[3 * k + c] += u[indices[d.elements.component_to_system_index(c, v)]];
    sums[3 * k + 2] += 1;
  });
  dealii::Utilities::MPI::sum(sums, d.mesh.get_communicator(), sums);
  std::vector<Vec2> result(corners);
  for (std::size_t k = 0; k < corners; ++k)
    result[k] = {sums[3 * k] / sums[3 * k + 2], sums[3 * k + 1] / sums[3 * k + 2]};
  return result;
}

// The field that is linear between the vertices of each quadrilateral.
FieldVector field_of_corners(const Discretisation& d, const SplitTriangles& split,
                             const std::vector<Vec2>& corners) {
  const std::vector<Vec2> at = split.places(corners);
  FieldVector field = d.field();
  std::vector<dealii::types::global_dof_index> indices(d.elements.n_dofs_per_cell());
  const auto& nodes = d.elements.base_element(0).get_unit_support_points();
  for (const auto& cell : d.unknowns.active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    cell->get_dof_indices(indices);
    for (unsigned int a = 0; a < nodes.size(); ++a) {
      Vec2 value;
      for (unsigned int v = 0; v < 4; ++v) {
        const double share = dealii::GeometryInfo<2>::d_linear_shape_function(nodes[a], v);
        value.x += share * at[cell->vertex_index(v)].x;
        value.z += share * at[cell->vertex_index(v)].z;
      }
      for (unsigned int c = 0; c < 2; ++c)
        if (const auto i = indices[d.elements.component_to_system_index(c, a)]; d.owned.is_element(i))
          field[i] = c == 0 ? value.x : value.z;
    }
  }
  field.update_ghost_values();
  return field;
}

// A flow on its way.
class FreeFlow {
 public:
  FreeFlow(const RegionMarch& plan, RegionState& state, const FlowSolverOptions& options,
           const RegionObserver& observer)
      : plan_(plan), state_(state), options_(options), observer_(observer) {
    watching_.interrupted = observer.interrupted;
    watching_.iteration = [this](const IterationReport& line) {
      ++now_.iterations;
      now_.residual = line.residual;
    };
    report_.start = "rest";
  }

  FlowField field() {
    begin();
    return FlowField(level_);
  }

  FlowReport march() {
    begin();
    if (observer_.frame && state_.steps == 0) observer_.frame(state_, now_, fem::field_of(level_));
    while (state_.time < plan_.end * (1 - 1e-12)) {
      now_ = {};
      if (!step()) {
        report_.failure =
            fmt::format("time {:.4g}, step {}: {}", state_.time, state_.steps + 1, report_.failure);
        break;
      }
      if (observer_.stepped) observer_.stepped(now_);
      if (observer_.frame &&
          std::find(plan_.frames.begin(), plan_.frames.end(), state_.time) != plan_.frames.end())
        observer_.frame(state_, now_, fem::field_of(level_));
    }
    report_.converged = report_.failure.empty();
    report_.residual = now_.residual;
    report_.seconds = fem::now() - begun_;
    for (std::size_t i = 0; i < fem::work_names.size(); ++i)
      report_.phases.push_back(
          {fem::work_names[i], clock_.seconds(static_cast<Work>(i)), clock_.times(static_cast<Work>(i))});
    return report_;
  }

 private:
  void begin() {
    discretise();
    auto& solution = level_->state.solution;
    if (!state_.values.empty() && state_.values.size() != solution.size())
      throw InputError("a kept state does not fit its mesh");
    for (std::size_t i = 0; i < state_.values.size(); ++i) solution[i] = state_.values[i];
    solution.update_ghost_values();
    (void)d().move_corners(level_->problem, state_.mesh.vertices);
  }

  // The level of the mesh as it is, at rest.
  void discretise() {
    level_ = std::make_shared<SolvedLevel>();
    level_->problem = plan_.problem;
    level_->problem.inertia = Inertia{};
    level_->problem.domain = MeshedDomain{std::make_shared<RegionMesh>(state_.mesh)};
    level_->problem.boundary = sides_of(plan_.region, state_.time);
    level_->discretisation = std::make_shared<Discretisation>(level_->problem);
    level_->state.theta = theta(state_.time);
    level_->state.solution = level_->discretisation->field();
    level_->state.solution.update_ghost_values();
    level_->setting = fem::final_setting(level_->problem);
    level_->state.dual =
        fem::dual_of(*level_->discretisation, level_->setting.regularisation, level_->state.solution);
    split_.emplace(state_.mesh);
  }

  double theta(double time) const {
    return plan_.theta ? plan_.theta(time) : std::get<FixedSlope>(plan_.problem.slope).theta;
  }
  Discretisation& d() { return *level_->discretisation; }

  CornerMotion material_motion() {
    const std::size_t corners = state_.mesh.vertices.size();
    const FieldVector& u = level_->state.solution;
    CornerMotion motion{velocity_at_corners(d(), corners, u), std::vector<Vec2>(corners),
                        std::vector<double>(corners, 0.0)};
    std::vector<double> sums(3 * corners, 0.0);
    outflow_ = outflow_energy_ = 0;
    dealii::FEFaceValues<2> face(
        d().mapping, d().elements, d().side_quadrature,
        dealii::update_values | dealii::update_normal_vectors | dealii::update_JxW_values);
    std::vector<dealii::Tensor<1, 2>> velocity(d().side_quadrature.size());
    for (const auto& cell : d().unknowns.active_cell_iterators()) {
      if (!cell->is_locally_owned()) continue;
      for (const unsigned int f : cell->face_indices()) {
        const auto side = cell->face(f);
        if (!side->at_boundary() || fem::condition_on(level_->problem, side->boundary_id())) continue;
        face.reinit(cell, f);
        face[dealii::FEValuesExtractors::Vector(0)].get_function_values(u, velocity);
        const bool is_free = side->boundary_id() == static_cast<int>(Side::top);
        // From the corner at one end to the middle of the triangle's side at the other.
        const bool corner_first = side->vertex_index(0) < corners;
        const unsigned int corner = side->vertex_index(corner_first ? 0 : 1);
        const auto& ends = split_->parents[side->vertex_index(corner_first ? 1 : 0)];
        const unsigned int other = ends[1] == corner ? ends[2] : ends[1];
        for (const unsigned int q : face.quadrature_point_indices()) {
          const double flux = velocity[q] * face.normal_vector(q) * face.JxW(q);
          if (!is_free) {
            outflow_ += flux;
            outflow_energy_ += 0.5 * plan_.problem.density * velocity[q].norm_square() * flux;
            continue;
          }
          const double along = d().side_quadrature.point(q)[0],
                       away = 0.5 * (corner_first ? along : 1 - along);
          for (const auto& [k, share] : {std::pair{corner, 1 - away}, std::pair{other, away}}) {
            sums[3 * k] += share * face.normal_vector(q)[0] * face.JxW(q);
            sums[3 * k + 1] += share * face.normal_vector(q)[1] * face.JxW(q);
            sums[3 * k + 2] += share * flux;
          }
        }
      }
    }
    dealii::Utilities::MPI::sum(sums, d().mesh.get_communicator(), sums);
    outflow_ = d().sum(outflow_);
    outflow_energy_ = d().sum(outflow_energy_);
    for (std::size_t k = 0; k < corners; ++k) {
      motion.free_normal[k] = {sums[3 * k], sums[3 * k + 1]};
      motion.free_flux[k] = sums[3 * k + 2];
    }
    return motion;
  }

  std::vector<Vec2> velocity_of_mesh(double time, const std::vector<Vec2>& corners) {
    return corner_velocities(plan_.region, time, state_.mesh, corners, material_motion());
  }

  // The longest step: to the next frame or change of a part at most.
  double longest_step(const std::vector<Vec2>& u) {
    double dt = plan_.step;
    for (std::size_t k = 0; k < u.size(); ++k) {
      const double speed = std::hypot(u[k].x, u[k].z);
      now_.fastest = std::max(now_.fastest, speed);
      dt = std::min(dt, cells_in_a_step * plan_.size(state_.mesh.vertices[k]) / std::max(speed, 1e-12));
    }
    return dt;
  }
  double next_event() const {
    double next = plan_.end;
    const auto consider = [&](double time) {
      if (time > state_.time && time < next) next = time;
    };
    for (const double frame : plan_.frames) consider(frame);
    for (const RegionPart& part : plan_.region.parts) consider(part.begins), consider(part.ends);
    return next;
  }

  bool step() {
    const std::vector<Vec2> from = state_.mesh.vertices;
    const double event = next_event();
    double dt = longest_step(velocity_at_corners(d(), from.size(), level_->state.solution));
    const auto left = std::ceil((event - state_.time) / dt - 1e-9);
    dt = (event - state_.time) / std::max(1.0, left);
    bool to_event = left <= 1;
    // No part begins or ends within a step.
    level_->problem.boundary = sides_of(plan_.region, state_.time + 0.5 * dt);
    const std::vector<Vec2> w = velocity_of_mesh(state_.time, from);
    const auto before = std::make_shared<FieldVector>(level_->state.solution);
    before->update_ghost_values();
    const fem::State old = level_->state;
    for (int halving = 0; halving <= plan_.halvings; ++halving, dt *= 0.5, to_event = false) {
      level_->state = old;
      level_->state.theta = theta(state_.time + dt);
      if (attempt(dt, from, w, before)) {
        state_.time = to_event ? event : state_.time + dt;
        finish(dt);
        return true;
      }
      if (report_.interrupted) return false;
    }
    return false;
  }

  bool attempt(double dt, const std::vector<Vec2>& from, const std::vector<Vec2>& w,
               const std::shared_ptr<FieldVector>& before) {
    if (!d().move_corners(level_->problem, moved(from, 0.5 * dt, w))) {
      report_.failure = "the mesh turned inside out";
      return false;
    }
    fem::Newton newton(level_->problem, options_, d(), 0, begun_, clock_, report_, watching_);
    const auto mesh_velocity = std::make_shared<FieldVector>(field_of_corners(d(), *split_, w));
    if (!fem::advance_once(newton, options_,
                           {.share = 1, .time_step = dt, .before = before, .mesh_velocity = mesh_velocity},
                           *level_))
      return false;
    report_.failure.clear();
    const std::vector<Vec2> middle = moved(from, 0.5 * dt, w);
    std::vector<Vec2> to = moved(from, dt, velocity_of_mesh(state_.time + 0.5 * dt, middle));
    look(dt);
    to = behind_moving_walls(on_curves(std::move(to), state_.time + dt), dt);
    if (!d().move_corners(level_->problem, to)) {
      report_.failure = "the mesh turned inside out";
      return false;
    }
    state_.mesh.vertices = std::move(to);
    state_.kinetic_energy = now_.sums.kinetic_energy;
    state_.power = power_;
    return true;
  }

  // What the step does, on the mesh at its middle.
  void look(double dt) {
    now_.sums = FlowField(level_).integrals();
    const auto& s = now_.sums;
    power_ = s.weight_power + s.given_side_power - s.dissipation - outflow_energy_;
    now_.energy_error = 0.5 * dt * (state_.power + power_) - (s.kinetic_energy - state_.kinetic_energy);
    now_.loads = loads();
  }

  // Where two parts meet, each takes what acts across it.
  std::vector<Vec2> loads() {
    const FieldVector forces = fem::nodal_forces(level_->problem, d(), level_->setting, level_->state);
    const auto places = fem::places_of_unknowns(d());
    const auto along_x = dealii::DoFTools::extract_dofs(
        d().unknowns, d().elements.component_mask(dealii::FEValuesExtractors::Scalar(0)));
    std::map<dealii::types::global_dof_index, std::pair<double, std::size_t>> part_of;
    for (std::size_t i = 0; i < plan_.region.parts.size(); ++i)
      for (const auto k : dealii::DoFTools::extract_boundary_dofs(
               d().unknowns, d().velocity_mask(),
               {static_cast<unsigned>(side_of_part(static_cast<int>(i)))})) {
        if (!d().owned.is_element(k)) continue;
        const auto& x = places.at(k);
        const PartLine line = line_of(plan_.region.parts[i], state_.time);
        const Vec2 t = line.tangent(line.nearest({x[0], x[1]}));
        const std::pair<double, std::size_t> here{std::abs(along_x.is_element(k) ? t.x : t.z), i};
        const auto [at, is_new] = part_of.try_emplace(k, here);
        if (!is_new) at->second = std::min(at->second, here);
      }
    std::vector<double> sums(2 * plan_.region.parts.size(), 0.0);
    for (const auto& [k, part] : part_of)
      sums[2 * part.second + (along_x.is_element(k) ? 0 : 1)] -= forces[k];
    dealii::Utilities::MPI::sum(sums, d().mesh.get_communicator(), sums);
    std::vector<Vec2> result;
    for (std::size_t i = 0; i < sums.size(); i += 2) result.push_back({sums[i], sums[i + 1]});
    return result;
  }

  static std::vector<Vec2> moved(std::vector<Vec2> x, double dt, const std::vector<Vec2>& w) {
    for (std::size_t k = 0; k < x.size(); ++k) x[k] = {x[k].x + dt * w[k].x, x[k].z + dt * w[k].z};
    return x;
  }
  // Corners on a circle stay on it.
  std::vector<Vec2> on_curves(std::vector<Vec2> x, double time) const {
    for (const auto& edge : state_.mesh.boundary) {
      if (edge.part < 0) continue;
      const RegionPart& part = plan_.region.parts[static_cast<std::size_t>(edge.part)];
      if (!std::holds_alternative<CircleCurve>(part.curve)) continue;
      const PartLine line = line_of(part, time);
      for (const unsigned int v : {edge.from, edge.to}) x[v] = line.at(line.nearest(x[v]));
    }
    return x;
  }

  // A contact that would pass the end of a wall which moves along its own stays at that end.
  std::vector<Vec2> behind_moving_walls(std::vector<Vec2> x, double dt) const {
    const auto& boundary = state_.mesh.boundary;
    for (std::size_t i = 0, n = boundary.size(); i < n; ++i) {
      const auto &before = boundary[(i + n - 1) % n], &after = boundary[i];
      if ((before.part < 0) == (after.part < 0)) continue;
      const RegionPart& wall =
          plan_.region.parts[static_cast<std::size_t>(std::max(before.part, after.part))];
      const unsigned int v = after.from, wet = before.part < 0 ? after.to : before.from;
      const PartLine old = line_of(wall, state_.time), now = line_of(wall, state_.time + dt);
      if (old.round()) continue;
      const Vec2 was = state_.mesh.vertices[v];
      const double dry = old.nearest(was) > old.nearest(state_.mesh.vertices[wet]) ? 1 : -1;
      for (const RegionPart& part : plan_.region.parts) {
        const Vec2 moves = wall_motion(part, state_.time);
        const PartLine from = line_of(part, state_.time), to = line_of(part, state_.time + dt);
        if (&part == &wall || !is_there(part, state_.time) || (moves.x == 0 && moves.z == 0)) continue;
        for (const double s : {0.0, to.length})
          if (now.distance(to.at(s)) < place_of_contact &&
              old.nearest(from.at(s)) * dry > old.nearest(was) * dry - hardly_past * plan_.size(was) &&
              now.nearest(x[v]) * dry > now.nearest(to.at(s)) * dry)
            x[v] = to.at(s);
      }
    }
    return x;
  }

  void finish(double dt) {
    ++state_.steps;
    ++state_.steps_on_mesh;
    state_.discharged += outflow_ * dt;
    state_.area -= outflow_ * dt;
    now_.area = area(outline_of(state_.mesh));
    remesh_where_needed();
    const auto& solution = level_->state.solution;
    state_.values.assign(solution.begin(), solution.end());
    report_.iterations += now_.iterations;
    RegionTotals& totals = state_.totals;
    totals.iterations += now_.iterations;
    totals.weight_work += dt * now_.sums.weight_power;
    totals.energy_error += now_.energy_error;
    totals.mass_error =
        std::max(totals.mass_error, std::abs(now_.area + state_.discharged - totals.fill) / totals.fill);
    now_.step = state_.steps;
    now_.time = state_.time;
    now_.time_step = dt;
    now_.area_wanted = state_.area;
    now_.discharged = state_.discharged;
    now_.discharge_rate = outflow_;
    now_.cells = static_cast<int>(d().mesh.n_global_active_cells());
  }

  // Walls that are no longer there leave a free surface before anything is laid down on them, and so do those
  // that would pull.
  void remesh_where_needed() {
    const Outline before = outline_of(state_.mesh);
    auto [laid, passed] =
        laid_down(relabelled(before, plan_.region, state_.time), plan_.region, state_.time, plan_.size);
    state_.discharged += passed;
    state_.area -= passed;
    let_go(laid);
    if (laid.part != before.part || state_.steps_on_mesh >= most_steps_on_a_mesh ||
        quality(state_.mesh) <= poorest_quality)
      remesh(laid);
  }

  // From the surface on, as far as a wall that moves away would have to pull the material along.
  void let_go(Outline& outline) const {
    const std::size_t n = outline.points.size();
    for (const std::size_t step : {std::size_t{1}, n - 1})
      for (std::size_t i = 0; i < n; ++i) {
        if (outline.part[i] >= 0) continue;
        for (std::size_t k = (i + step) % n; outline.part[k] >= 0 && pulls(outline, k); k = (k + step) % n)
          outline.part[k] = Outline::free;
      }
  }
  bool pulls(const Outline& outline, std::size_t side) const {
    const RegionPart& part = plan_.region.parts[static_cast<std::size_t>(outline.part[side])];
    const Vec2 moves = wall_motion(part, state_.time);
    const Vec2 a = outline.points[side], b = outline.points[(side + 1) % outline.points.size()];
    const double length = std::hypot(b.x - a.x, b.z - a.z);
    const Vec2 n{(b.z - a.z) / length, (a.x - b.x) / length};
    if (!(moves.x * n.x + moves.z * n.z > 0)) return false;
    const std::array<Vec2, 1> middle = {{{0.5 * (a.x + b.x), 0.5 * (a.z + b.z)}}};
    const PointState at = FlowField(level_).at(middle).front();
    return n.x * n.x * at.sigma_xx + n.z * n.z * at.sigma_zz - 2 * n.x * n.z * at.sigma_xz < 0;
  }

  void remesh(const Outline& outline) {
    clock_(Work::refinement, [&] {
      const std::shared_ptr<SolvedLevel> old = level_;
      const RegionMesh old_mesh = state_.mesh;
      state_.mesh = mesh_of(with_area(resampled(outline, plan_.region, state_.time, plan_.size), plan_.region,
                                      state_.time, state_.area),
                            plan_.size);
      discretise();
      transfer(*old, old_mesh);
      state_.steps_on_mesh = 0;
      now_.remeshed = true;
    });
  }

  // Values of the old field at the nodes of the new mesh.
  void transfer(const SolvedLevel& old, const RegionMesh& old_mesh) {
    struct Node {
      dealii::types::global_dof_index x = 0, z = 0, p = dealii::numbers::invalid_dof_index;
    };
    std::vector<Vec2> points;
    std::vector<Node> nodes;
    std::vector<bool> seen(d().unknowns.n_dofs(), false);
    std::vector<dealii::types::global_dof_index> indices(d().elements.n_dofs_per_cell());
    const auto& units = d().elements.base_element(0).get_unit_support_points();
    for (const auto& cell : d().unknowns.active_cell_iterators()) {
      if (cell->is_artificial()) continue;
      cell->get_dof_indices(indices);
      for (unsigned int a = 0; a < units.size(); ++a) {
        Node node{indices[d().elements.component_to_system_index(0, a)],
                  indices[d().elements.component_to_system_index(1, a)]};
        if (seen[node.x]) continue;
        seen[node.x] = true;
        if (a < 4) node.p = indices[d().elements.component_to_system_index(fem::pressure_component, a)];
        const auto x = d().mapping.transform_unit_to_real_cell(cell, units[a]);
        points.push_back({x[0], x[1]});
        nodes.push_back(node);
      }
    }
    const auto states =
        values_near(FlowField(std::shared_ptr<const SolvedLevel>(&old, [](auto*) {})), old_mesh, points);
    FieldVector& solution = level_->state.solution;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const auto set = [&](dealii::types::global_dof_index i, double value) {
        if (i != dealii::numbers::invalid_dof_index && d().owned.is_element(i)) solution[i] = value;
      };
      set(nodes[k].x, states[k].velocity.x);
      set(nodes[k].z, states[k].velocity.z);
      set(nodes[k].p, states[k].pressure);
    }
    solution.update_ghost_values();
  }

  // Outside of the old mesh the value of its nearest point.
  static std::vector<PointState> values_near(const FlowField& field, const RegionMesh& mesh,
                                             std::vector<Vec2> points) {
    std::vector<PointState> states = field.at(points);
    std::vector<Vec2> outside;
    std::vector<std::size_t> which;
    for (std::size_t k = 0; k < points.size(); ++k)
      if (!std::isfinite(states[k].velocity.x)) {
        which.push_back(k);
        outside.push_back(nearest_on(mesh, points[k]));
      }
    const std::vector<PointState> there = field.at(outside);
    for (std::size_t i = 0; i < which.size(); ++i) {
      states[which[i]] = there[i];
      if (!std::isfinite(there[i].velocity.x))
        throw NotConvergedError("a new mesh lies far outside of the old one");
    }
    return states;
  }
  static Vec2 nearest_on(const RegionMesh& mesh, Vec2 point) {
    Vec2 best;
    double least = INFINITY;
    for (const auto& edge : mesh.boundary) {
      const Vec2 at = nearest_point({mesh.vertices[edge.from], mesh.vertices[edge.to]}, point);
      const double distance = std::hypot(at.x - point.x, at.z - point.z);
      if (distance < least) least = distance, best = at;
    }
    return best;
  }

  const double begun_ = fem::now();
  const RegionMarch& plan_;
  RegionState& state_;
  const FlowSolverOptions& options_;
  const RegionObserver& observer_;
  FlowObserver watching_;
  FlowReport report_;
  fem::WorkClock clock_;
  std::shared_ptr<SolvedLevel> level_;
  std::optional<SplitTriangles> split_;
  RegionStep now_;
  // Area and kinetic energy per time, of the last look at the material's motion.
  double outflow_ = 0, outflow_energy_ = 0;
  double power_ = 0;  // of the weight and the walls, less what is lost to the law and carried out
};

}  // namespace

Outline outline_of(const RegionMesh& mesh) {
  Outline outline;
  for (const auto& edge : mesh.boundary) {
    outline.points.push_back(mesh.vertices[edge.from]);
    outline.part.push_back(edge.part);
  }
  return outline;
}

RegionState filled(const RegionMarch& march) {
  const Outline fill = outline_of(march.region, 0, march.size);
  RegionState state;
  state.area = state.totals.fill = area(fill);
  state.mesh = mesh_of(fill, march.size);
  return state;
}

FlowField flow_of(const RegionMarch& march, const RegionState& state) {
  RegionState copy = state;
  return FreeFlow(march, copy, {}, {}).field();
}

FlowReport march_region(const RegionMarch& march, RegionState& state, const FlowSolverOptions& options,
                        const RegionObserver& observer) {
  return FreeFlow(march, state, options, observer).march();
}

}  // namespace drumlin::continuum
