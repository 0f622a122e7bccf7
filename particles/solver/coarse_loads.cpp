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
// Of a cell, at least, over the distance of the bodies of a contact; 2, but for rounding.
constexpr double edges_per_contact = 2.001;

/// A distance along x or z; added up, the longest.
struct Longest {
  double distance = 0;
  void add(const Longest& other) { distance = std::max(distance, other.distance); }
};

/// The four entries of a Move as one vector.
auto vector_of(auto& move) {
  using Entries = std::conditional_t<std::is_const_v<std::remove_reference_t<decltype(move)>>,
                                     const Eigen::Array4f, Eigen::Array4f>;
  return Eigen::Map<Entries, Eigen::Aligned16>(move.entries.data());
}

double longest_contact(const CoarseProblem& problem, const BodyPlaces& places, const TeamLoops& loops) {
  const auto fixed = static_cast<std::int32_t>(problem.inverse_mass.size()) - 1;
  return loops
      .combined<Longest>(problem.i.size(),
                         [&](std::size_t begin, std::size_t end) {
                           Longest own;
                           for (std::size_t a = begin; a < end; ++a) {
                             const std::int32_t i = problem.i[a], j = problem.j[a];
                             if (j == fixed) continue;
                             own.add({std::abs(places.x[i] - places.x[j])});
                             own.add({std::abs(places.z[i] - places.z[j])});
                           }
                           return own;
                         })
      .distance;
}

}  // namespace

CoarseLoads::Grid CoarseLoads::grid_over(const BodyPlaces& places, std::size_t contacts,
                                         double longest_contact) {
  const auto [x_low, x_high] = std::minmax_element(places.x.begin(), places.x.end());
  const auto [z_low, z_high] = std::minmax_element(places.z.begin(), places.z.end());
  const double width = *x_high - *x_low, height = *z_high - *z_low;
  const double cells =
      std::max(1.0, std::round(std::sqrt(static_cast<double>(contacts) / contacts_per_cell)));
  Grid grid{*x_low, *z_low, std::max(width, height) / cells};
  // The nodes around one body of a contact are then among the nine of the other.
  grid.edge = std::max(grid.edge, edges_per_contact * longest_contact);
  if (!(grid.edge > 0)) grid.edge = 1;
  grid.columns = std::max(1, static_cast<int>(std::ceil(width / grid.edge))) + 1;
  grid.rows = std::max(1, static_cast<int>(std::ceil(height / grid.edge))) + 1;
  return grid;
}

CoarseLoads::Place CoarseLoads::place_at(double x, double z) const {
  const double from_left = (x - grid_.x) / grid_.edge, from_below = (z - grid_.z) / grid_.edge;
  const auto node = [](double from, int last) {
    return static_cast<std::int16_t>(std::clamp(static_cast<int>(from), 0, last));
  };
  Place place{node(from_left, grid_.columns - 2), node(from_below, grid_.rows - 2),
              node(from_left + 0.5, grid_.columns - 1), node(from_below + 0.5, grid_.rows - 1)};
  place.right = from_left - place.column, place.up = from_below - place.row;
  return place;
}

void CoarseLoads::lay_out(const CoarseProblem& problem, const BodyPlaces& places, const TeamLoops& loops) {
  grid_ = grid_over(places, problem.i.size(), longest_contact(problem, places, loops));
  rank_.renew(places.x.size());
  places_.renew(places.x.size());
  moves_.renew(places.x.size());
  loops.each(places_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t rank = begin; rank < end; ++rank) {
      const std::int32_t b = problem.plan.body_order[rank];
      rank_[b] = static_cast<std::int32_t>(rank);
      places_[rank] = place_at(places.x[b], places.z[b]);
      places_[rank].inverse_mass = problem.inverse_mass[b];
    }
  });
}

/// The contacts of a slice.
void CoarseLoads::add_contacts(const CoarseProblem& problem, std::span<const double> u,
                               std::span<const double> r, int slice, std::vector<double>& work) {
  const SweepPlan& plan = problem.plan;
  const auto fixed = static_cast<std::int32_t>(problem.inverse_mass.size()) - 1;
  const auto move = [&](std::int32_t rank, const Place& at, const Eigen::Array4f& weights,
                        const Eigen::Array4f& push) {
    const Place& own = places_[rank];
    const Eigen::Array4f change = static_cast<float>(own.inverse_mass) * push;
    // Of the lower left node around the contact.
    Move* const first = &moves_[rank][3 * (at.row - own.next_row + 1) + at.column - own.next_column + 1];
    vector_of(first[0]) += weights[0] * change, vector_of(first[1]) += weights[1] * change;
    vector_of(first[3]) += weights[2] * change, vector_of(first[4]) += weights[3] * change;
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
    const std::int32_t i = rank_[problem.i[a]], j = problem.j[a];
    const Place& at = places_[i];
    const auto weights = at.weights();
    for (const int k : {0, 1, 2, 3}) work[grid_.index(at.column + k % 2, at.row + k / 2)] += weights[k] * g;
    const auto p_x = static_cast<float>(problem.n_x[a] * r_n + problem.n_z[a] * r_t);
    const auto p_z = static_cast<float>(problem.n_z[a] * r_n - problem.n_x[a] * r_t);
    const auto p_s = static_cast<float>(problem.spin ? -2 * r_t : 0);
    const Eigen::Array4f shares = Eigen::Array4d::Map(weights.data()).cast<float>();
    move(i, at, shares, {p_x, p_z, p_s, 0});
    if (j < fixed) move(rank_[j], at, shares, {-p_x, -p_z, p_s, 0});
  }
}

/// Scalar products of what the hats of two nodes do to the bodies of a strip: m v . v' + J omega omega', with
/// J = m r^2 / 2 and s = r omega.
void CoarseLoads::add_bodies(const CoarseProblem& problem, int strip, std::vector<Row>& rows) const {
  for (std::int32_t rank = problem.plan.strip_bodies[strip]; rank < problem.plan.strip_bodies[strip + 1];
       ++rank) {
    const Place& at = places_[rank];
    const Moves& moves = moves_[rank];
    const double mass = 1 / at.inverse_mass;
    std::array<int, 9> moved{};
    int count = 0;
    for (int k = 0; k < 9; ++k)
      if ((vector_of(moves[k]) != 0).any()) moved[count++] = k;
    for (int m = 0; m < count; ++m) {
      const int k = moved[m];
      const Eigen::Array4f v = vector_of(moves[k]) * Eigen::Array4f(1, 1, 0.5F, 0);
      Row& row = rows[grid_.index(at.next_column + k % 3 - 1, at.next_row + k / 3 - 1)];
      for (int n = m; n < count; ++n) {
        const int l = moved[n];
        row[5 * (l / 3 - k / 3) + l % 3 - k % 3] +=
            mass * static_cast<double>((v * vector_of(moves[l])).sum());
      }
    }
  }
}

/// Strip by strip, as long as what a strip moves is in the caches. The second slice of a part's last strip
/// touches the first one of the next part, and waits until the parts are done.
void CoarseLoads::add_up(const CoarseProblem& problem, std::span<const double> u, std::span<const double> r,
                         const TeamLoops& loops) {
  const int strips = problem.plan.strips();
  const auto rest = [&](int strip) {
    const auto& first = problem.plan.strip_bodies;
    std::fill(moves_.begin() + first[strip], moves_.begin() + first[strip + 1], Moves{});
  };
  const auto first_of = [&](int part) { return strips * part / parts; };
  loops.each_of(parts, [&](int part) {
    const int begin = first_of(part), end = first_of(part + 1);
    if (begin < end) rest(begin);
    for (int k = begin; k < end; ++k) {
      add_contacts(problem, u, r, 2 * k, work_[part]);
      if (k + 1 == end) break;
      rest(k + 1);
      add_contacts(problem, u, r, 2 * k + 1, work_[part]);
      if (k > begin) add_bodies(problem, k, rows_[part]);
    }
  });
  for (int part = 0; part < parts; ++part)
    if (const int last = first_of(part + 1) - 1; last >= first_of(part))
      add_contacts(problem, u, r, 2 * last + 1, work_[part]);
  loops.each_of(parts, [&](int part) {
    const int begin = first_of(part), last = first_of(part + 1) - 1;
    if (last >= begin) add_bodies(problem, begin, rows_[part]);
    if (last > begin) add_bodies(problem, last, rows_[part]);
  });
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
  double largest = 0;
  for (const Row& row : sum) largest = std::max(largest, row[0]);
  if (!(largest > 0)) return false;
  std::vector<Eigen::Triplet<double>> entries;  // of the lower triangle
  for (int k = 0; k < nodes; ++k)
    for (int e = 0; e < 13; ++e) {
      const int aside = (e + 2) % 5 - 2, above = (e + 2) / 5;
      const int column = k % grid_.columns + aside, row = k / grid_.columns + above;
      if (column < 0 || column >= grid_.columns || row >= grid_.rows) continue;
      double value = sum[k][e];
      if (e == 0) value += damping * value + ground * largest;
      if (value != 0) entries.emplace_back(row * grid_.columns + column, k, value);
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

void CoarseLoads::scale(const CoarseProblem& problem, std::span<const double> u, std::vector<double>& r,
                        const TeamLoops& loops) {
  for (auto& work : work_) work.assign(grid_.nodes(), 0.0);
  for (auto& rows : rows_) rows.assign(grid_.nodes(), Row{});
  add_up(problem, u, r, loops);
  if (!solve()) return;
  loops.each(problem.i.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t a = begin; a < end; ++a) {
      const Place& at = places_[rank_[problem.i[a]]];
      const auto weights = at.weights();
      double factor = 1;
      for (const int k : {0, 1, 2, 3})
        factor += weights[k] * field_[grid_.index(at.column + k % 2, at.row + k / 2)];
      factor = std::clamp(factor, 0.5, 2.0);
      for (int c = 0; c < problem.dim; ++c) r[problem.dim * a + c] *= factor;
    }
  });
}

}  // namespace drumlin::particles
