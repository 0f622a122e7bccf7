#include <deal.II/base/mpi.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold_lib.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "continuum/fem/detail/split_triangles.hpp"

namespace drumlin::continuum::fem {
namespace {

using dealii::Point;

constexpr dealii::types::manifold_id arc_manifold = 0;
constexpr dealii::types::manifold_id block_manifold = 1;

// Six blocks: two inner ones below the middle of the chord, one at each end of the chord, two along the
// bottom. Both corners of the domain are corners of one block, so that no cell there is squeezed between
// chord and arc.
void make_blocks(const ChordDomain& domain, dealii::Triangulation<2>& mesh) {
  const double R = domain.radius;
  const double half_angle = std::acos(domain.axis_offset / R);  // of the arc, from its lowest point
  const double w = R * std::sin(half_angle);
  const double depth = R - domain.axis_offset;
  const auto arc = [&](double angle) {
    return Point<2>(R * std::sin(angle), domain.axis_offset - R * std::cos(angle));
  };
  const Point<2> shoulder = arc(0.5 * half_angle);
  const double inner_x = 0.62 * shoulder[0], inner_z = 0.62 * shoulder[1];
  const std::vector<Point<2>> vertices = {{-w, 0},
                                          {-0.5 * w, 0},
                                          {0, 0},
                                          {0.5 * w, 0},
                                          {w, 0},  // 0-4 along the chord
                                          {-inner_x, inner_z},
                                          {0, 0.55 * -depth},
                                          {inner_x, inner_z},
                                          arc(-0.5 * half_angle),
                                          arc(0),
                                          arc(0.5 * half_angle)};
  const std::vector<std::array<unsigned int, 4>> corners = {{5, 6, 1, 2},  {6, 7, 2, 3}, {8, 5, 0, 1},
                                                            {7, 10, 3, 4}, {8, 9, 5, 6}, {9, 10, 6, 7}};
  std::vector<dealii::CellData<2>> cells(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i)
    std::copy(corners[i].begin(), corners[i].end(), cells[i].vertices.begin());
  dealii::GridTools::consistently_order_cells(cells);
  mesh.create_triangulation(vertices, cells, dealii::SubCellData());
}

double target_size(const ChordDomain& domain, const Point<2>& p) {
  return domain.surface_cell + domain.growth * std::max(0.0, -p[1] - domain.surface_zone);
}

void make_mesh(const ChordDomain& domain, dealii::parallel::distributed::Triangulation<2>& mesh) {
  make_blocks(domain, mesh);
  mesh.set_all_manifold_ids(block_manifold);
  for (const auto& cell : mesh.active_cell_iterators())
    for (const auto& face : cell->face_iterators())
      if (face->at_boundary()) {
        const bool on_chord =
            std::abs(face->vertex(0)[1]) + std::abs(face->vertex(1)[1]) < 1e-9 * domain.radius;
        face->set_boundary_id(static_cast<int>(on_chord ? Side::top : Side::bottom));
        face->set_manifold_id(on_chord ? dealii::numbers::flat_manifold_id : arc_manifold);
      }
  mesh.set_manifold(arc_manifold, dealii::SphericalManifold<2>(Point<2>(0, domain.axis_offset)));
  dealii::TransfiniteInterpolationManifold<2> blocks;
  blocks.initialize(mesh);
  mesh.set_manifold(block_manifold, blocks);

  for (int pass = 0; pass < 20; ++pass) {
    bool any = false;
    for (const auto& cell : mesh.active_cell_iterators())
      if (cell->is_locally_owned() &&
          cell->diameter() / std::sqrt(2.0) > 1.2 * target_size(domain, cell->center())) {
        cell->set_refine_flag();
        any = true;
      }
    if (!dealii::Utilities::MPI::logical_or(any, mesh.get_communicator())) break;
    mesh.execute_coarsening_and_refinement();
  }
}

void make_mesh(const BoxDomain& domain, dealii::parallel::distributed::Triangulation<2>& mesh) {
  std::vector<double> rows(domain.layers.rbegin(), domain.layers.rend());
  if (rows.empty()) rows.assign(domain.cells_z, domain.height / domain.cells_z);
  dealii::GridGenerator::subdivided_hyper_rectangle(
      mesh, {std::vector<double>(domain.cells_x, domain.width / domain.cells_x), rows},
      Point<2>(-0.5 * domain.width, -domain.height), Point<2>(0.5 * domain.width, 0));
  constexpr std::array<Side, 4> side_of_face = {Side::left, Side::right, Side::bottom, Side::top};
  for (const auto& cell : mesh.active_cell_iterators())
    for (const unsigned int f : cell->face_indices())
      if (cell->face(f)->at_boundary()) cell->face(f)->set_boundary_id(static_cast<int>(side_of_face[f]));
  if (!domain.periodic_x) return;
  std::vector<dealii::GridTools::PeriodicFacePair<dealii::Triangulation<2>::cell_iterator>> pairs;
  dealii::GridTools::collect_periodic_faces(mesh, static_cast<int>(Side::left), static_cast<int>(Side::right),
                                            0, pairs);
  mesh.add_periodicity(pairs);  // cells across the seam count as neighbours among the ranks
}

// Rings of cells of any thickness, which no generator of deal.II makes.
void make_mesh(const AnnulusDomain& domain, dealii::parallel::distributed::Triangulation<2>& mesh) {
  const auto around = static_cast<unsigned>(domain.cells_around),
             rings = static_cast<unsigned>(domain.layers.size());
  std::vector<Point<2>> vertices;
  double r = domain.inner_radius;
  for (unsigned ring = 0; ring <= rings; ++ring) {
    for (unsigned k = 0; k < around; ++k) {
      const double angle = 2 * std::numbers::pi * k / around;
      vertices.emplace_back(r * std::cos(angle), r * std::sin(angle));
    }
    if (ring < rings) r += domain.layers[ring];
  }
  std::vector<dealii::CellData<2>> cells;
  for (unsigned ring = 0; ring < rings; ++ring)
    for (unsigned k = 0; k < around; ++k) {
      const unsigned next = (k + 1) % around;
      dealii::CellData<2> cell;
      cell.vertices = {ring * around + k, (ring + 1) * around + k, ring * around + next,
                       (ring + 1) * around + next};
      cells.push_back(cell);
    }
  mesh.create_triangulation(vertices, cells, dealii::SubCellData());
  mesh.set_all_manifold_ids(arc_manifold);
  const double middle = domain.inner_radius + 0.5 * (r - domain.inner_radius);
  for (const auto& cell : mesh.active_cell_iterators())
    for (const auto& face : cell->face_iterators())
      if (face->at_boundary())
        face->set_boundary_id(static_cast<int>(face->vertex(0).norm() < middle ? Side::top : Side::bottom));
  mesh.set_manifold(arc_manifold, dealii::SphericalManifold<2>());
}

// Corners, then the middles of the sides, then the centres. Collective: all ranks hold the same triangles.
void make_mesh(const MeshedDomain& domain, dealii::parallel::distributed::Triangulation<2>& mesh) {
  const SplitTriangles split(*domain.mesh);
  std::vector<Point<2>> vertices;
  for (const Vec2& x : split.places(domain.mesh->vertices)) vertices.emplace_back(x.x, x.z);
  std::vector<dealii::CellData<2>> cells(split.cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto& [a, b, c, d] = split.cells[i];
    cells[i].vertices = {a, b, d, c};
  }
  dealii::GridTools::consistently_order_cells(cells);
  mesh.create_triangulation(vertices, cells, dealii::SubCellData());
  for (const auto& cell : mesh.active_cell_iterators())
    for (const auto& face : cell->face_iterators())
      if (face->at_boundary())
        face->set_boundary_id(
            static_cast<int>(side_of_part(split.part_of({face->vertex_index(0), face->vertex_index(1)}))));
}

}  // namespace

SplitTriangles::SplitTriangles(const RegionMesh& mesh) {
  for (unsigned int v = 0; v < mesh.vertices.size(); ++v) parents.push_back({v, v, v});
  std::map<Pair, unsigned int> middles;
  const auto middle = [&](unsigned int a, unsigned int b) {
    const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<unsigned>(parents.size()));
    if (is_new) parents.push_back({a, a, b});
    return at->second;
  };
  std::vector<std::array<unsigned int, 3>> sides;
  for (const auto& [a, b, c] : mesh.triangles) sides.push_back({middle(a, b), middle(b, c), middle(c, a)});
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corner = mesh.triangles[t];
    const auto center = static_cast<unsigned>(parents.size());
    parents.push_back(corner);
    for (unsigned int k = 0; k < 3; ++k)
      cells.push_back({corner[k], sides[t][k], center, sides[t][(k + 2) % 3]});
  }
  for (const auto& edge : mesh.boundary) {
    const unsigned int m = middles.at(std::minmax(edge.from, edge.to));
    for (const unsigned int end : {edge.from, edge.to}) parts_[std::minmax(end, m)] = edge.part;
  }
}

std::vector<Vec2> SplitTriangles::places(std::span<const Vec2> corners) const {
  std::vector<Vec2> result;
  result.reserve(parents.size());
  for (const auto& [a, b, c] : parents) {
    const Vec2 &p = corners[a], &q = corners[b], &r = corners[c];
    result.push_back(a == b && b == c ? p
                     : a == b         ? Vec2{0.5 * (p.x + r.x), 0.5 * (p.z + r.z)}
                                      : Vec2{(p.x + q.x + r.x) / 3, (p.z + q.z + r.z) / 3});
  }
  return result;
}

void make_mesh(const Domain& domain, dealii::parallel::distributed::Triangulation<2>& mesh) {
  std::visit([&](const auto& chosen) { make_mesh(chosen, mesh); }, domain);
}

}  // namespace drumlin::continuum::fem
