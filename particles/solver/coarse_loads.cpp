#include "particles/solver/coarse_loads.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

namespace drumlin::particles {
namespace {

// Of a cell of a full packing: the field of 100,000 discs has some twelve cells along its longer side.
constexpr double contacts_per_cell = 1400;
// Added to the diagonal, in parts of it and of its largest entry: nodes without loads keep s = 0.
constexpr double damping = 1e-3, ground = 1e-10;
// A tangential impulse that is so near to its bound, in parts of that, slides.
constexpr double sliding = 1e-6;

}  // namespace

CoarseLoads::Grid CoarseLoads::grid_over(const BodyPlaces& places, std::size_t contacts) {
  const auto [x_low, x_high] = std::minmax_element(places.x.begin(), places.x.end());
  const auto [z_low, z_high] = std::minmax_element(places.z.begin(), places.z.end());
  const double width = *x_high - *x_low, height = *z_high - *z_low;
  const double cells =
      std::max(1.0, std::round(std::sqrt(static_cast<double>(contacts) / contacts_per_cell)));
  Grid grid{*x_low, *z_low, std::max(width, height) / cells};
  if (!(grid.edge > 0)) grid.edge = 1;
  grid.columns = std::max(1, static_cast<int>(std::ceil(width / grid.edge))) + 1;
  grid.rows = std::max(1, static_cast<int>(std::ceil(height / grid.edge))) + 1;
  return grid;
}

CoarseLoads::Weights CoarseLoads::weights_at(const Grid& grid, double x, double z) {
  const double from_left = (x - grid.x) / grid.edge, from_below = (z - grid.z) / grid.edge;
  Weights weights;
  weights.first = {std::clamp(static_cast<int>(from_left), 0, grid.columns - 2),
                   std::clamp(static_cast<int>(from_below), 0, grid.rows - 2)};
  const double right = from_left - weights.first.column, up = from_below - weights.first.row;
  weights.of = {(1 - right) * (1 - up), right * (1 - up), (1 - right) * up, right * up};
  return weights;
}

CoarseLoads::Node CoarseLoads::nearest(const Grid& grid, double x, double z) {
  return {std::clamp(static_cast<int>((x - grid.x) / grid.edge + 0.5), 0, grid.columns - 1),
          std::clamp(static_cast<int>((z - grid.z) / grid.edge + 0.5), 0, grid.rows - 1)};
}

/// The contacts of a slice: slices of the same parity share no body.
void CoarseLoads::add_contacts(const CoarseProblem& problem, const BodyPlaces& places,
                               std::span<const double> u, std::span<const double> r, int slice,
                               std::vector<double>& work) {
  const SweepPlan& plan = problem.plan;
  const auto fixed = static_cast<std::int32_t>(problem.inverse_mass.size()) - 1;
  const auto move = [&](std::int32_t b, const Weights& at, double p_x, double p_z, double p_s) {
    const Node middle = nearest(grid_, places.x[b], places.z[b]);
    Moves& moves = moves_[b];
    for (int k = 0; k < 4; ++k) {
      const int column = at.first.column + k % 2 - middle.column + 1,
                row = at.first.row + k / 2 - middle.row + 1;
      if (column < 0 || column > 2 || row < 0 || row > 2) continue;  // no contact is half a cell long
      const double weight = at.of[k] * problem.inverse_mass[b];
      moves.x[3 * row + column] += static_cast<float>(weight * p_x);
      moves.z[3 * row + column] += static_cast<float>(weight * p_z);
      moves.s[3 * row + column] += static_cast<float>(weight * p_s);
    }
  };
  const std::int32_t end = plan.group_start[plan.slice_start[slice + 1]];
  for (std::int32_t a = plan.group_start[plan.slice_start[slice]]; a < end; ++a) {
    const double* const r_a = r.data() + static_cast<std::ptrdiff_t>(problem.dim) * a;
    const double* const u_a = u.data() + static_cast<std::ptrdiff_t>(problem.dim) * a;
    if (!(r_a[0] > 0)) continue;
    const double r_n = r_a[0], r_t = problem.dim == 2 ? r_a[1] : 0;
    double g = r_n * u_a[0];
    if (problem.dim == 2) {
      const double bound = r_n * problem.mu[a];
      const bool slides = std::abs(r_t) >= bound * (1 - sliding);
      g += r_t * u_a[1] + (slides ? bound * std::abs(u_a[1]) : 0);
    }
    const std::int32_t i = problem.i[a], j = problem.j[a];
    const Weights at = weights_at(grid_, places.x[i], places.z[i]);
    for (int k = 0; k < 4; ++k)
      work[grid_.index({at.first.column + k % 2, at.first.row + k / 2})] += at.of[k] * g;
    const double p_x = problem.n_x[a] * r_n + problem.n_z[a] * r_t;
    const double p_z = problem.n_z[a] * r_n - problem.n_x[a] * r_t, p_s = problem.spin ? -2 * r_t : 0;
    move(i, at, p_x, p_z, p_s);
    if (j < fixed) move(j, at, -p_x, -p_z, p_s);
  }
}

/// Scalar products of what the hats of two nodes do to the bodies of a strip: m v . v' + J omega omega', with
/// J = m r^2 / 2 and s = r omega.
void CoarseLoads::add_bodies(const CoarseProblem& problem, const BodyPlaces& places, int strip,
                             std::vector<Row>& rows) const {
  for (std::int32_t o = problem.plan.strip_bodies[strip]; o < problem.plan.strip_bodies[strip + 1]; ++o) {
    const std::int32_t b = problem.plan.body_order[o];
    const double mass = 1 / problem.inverse_mass[b];
    const Node middle = nearest(grid_, places.x[b], places.z[b]);
    const Moves& v = moves_[b];
    for (int k = 0; k < 9; ++k) {
      if (v.x[k] == 0 && v.z[k] == 0 && v.s[k] == 0) continue;
      Row& row = rows[grid_.index({middle.column + k % 3 - 1, middle.row + k / 3 - 1})];
      for (int l = 0; l < 9; ++l)
        row[5 * (l / 3 - k / 3 + 2) + l % 3 - k % 3 + 2] +=
            mass * (static_cast<double>(v.x[k]) * v.x[l] + static_cast<double>(v.z[k]) * v.z[l] +
                    static_cast<double>(v.s[k]) * v.s[l] / 2);
    }
  }
}

/// Solves for the field; false where the matrix or the result is no good.
bool CoarseLoads::solve() {
  const auto nodes = static_cast<Eigen::Index>(grid_.nodes());
  Eigen::VectorXd right = Eigen::VectorXd::Zero(nodes);
  for (const auto& work : work_)
    for (Eigen::Index k = 0; k < nodes; ++k) right[k] -= work[k];
  std::vector<Row> sum = rows_[0];
  for (std::size_t strip = 1; strip < rows_.size(); ++strip)
    for (std::size_t k = 0; k < sum.size(); ++k)
      for (std::size_t e = 0; e < sum[k].size(); ++e) sum[k][e] += rows_[strip][k][e];
  constexpr int diagonal = 12;
  double largest = 0;
  for (const Row& row : sum) largest = std::max(largest, row[diagonal]);
  if (!(largest > 0)) return false;
  std::vector<Eigen::Triplet<double>> entries;
  for (int k = 0; k < nodes; ++k)
    for (int e = 0; e < 25; ++e) {
      const int column = k % grid_.columns + e % 5 - 2, row = k / grid_.columns + e / 5 - 2;
      if (column < 0 || column >= grid_.columns || row < 0 || row >= grid_.rows) continue;
      double value = sum[k][e];
      if (e == diagonal) value += damping * value + ground * largest;
      if (value != 0) entries.emplace_back(k, row * grid_.columns + column, value);
    }
  Eigen::SparseMatrix<double> matrix(nodes, nodes);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(matrix);
  if (factors.info() != Eigen::Success) return false;
  const Eigen::VectorXd field = factors.solve(right);
  if (!field.allFinite()) return false;
  field_.assign(field.begin(), field.end());
  return true;
}

void CoarseLoads::scale(const CoarseProblem& problem, const BodyPlaces& places, std::span<const double> u,
                        std::vector<double>& r, const TeamLoops& loops) {
  grid_ = grid_over(places, problem.i.size());
  moves_.assign(places.x.size(), Moves{});
  const int strips = problem.plan.strips();
  for (auto& work : work_) work.assign(grid_.nodes(), 0.0);
  for (auto& rows : rows_) rows.assign(grid_.nodes(), Row{});
  const auto each_strip = [&](auto visit) {
    loops.each_of(parts, [&](int part) {
      for (int k = strips * part / parts; k < strips * (part + 1) / parts; ++k) visit(k, part);
    });
  };
  for (const int parity : {0, 1})
    each_strip([&](int k, int part) { add_contacts(problem, places, u, r, 2 * k + parity, work_[part]); });
  each_strip([&](int k, int part) { add_bodies(problem, places, k, rows_[part]); });
  if (!solve()) return;
  loops.each(problem.i.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t a = begin; a < end; ++a) {
      const Weights at = weights_at(grid_, places.x[problem.i[a]], places.z[problem.i[a]]);
      double factor = 1;
      for (int k = 0; k < 4; ++k)
        factor += at.of[k] * field_[grid_.index({at.first.column + k % 2, at.first.row + k / 2})];
      factor = std::clamp(factor, 0.5, 2.0);
      for (int c = 0; c < problem.dim; ++c) r[problem.dim * a + c] *= factor;
    }
  });
}

}  // namespace drumlin::particles
