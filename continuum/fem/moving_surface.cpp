#include "continuum/fem/detail/moving_surface.hpp"

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "continuum/fem/detail/spring_faces.hpp"

namespace drumlin::continuum::fem {
namespace {

constexpr double corner = 2;  // d

struct Sums {
  dealii::FullMatrix<double> gram;
  std::vector<double> product;
  double square = 0, length = 0, largest = 0;
};

void add_point(const SurfaceShape& shape, Vec2 point, double height, double dx, Sums& sums) {
  const double s = across(shape, point);
  const Vec2 left = surface_point(shape, -1), right = surface_point(shape, 1);
  const double from_end = std::min(std::hypot(point.x - left.x, point.z - left.z),
                                   std::hypot(point.x - right.x, point.z - right.z));
  if (from_end > corner) {
    sums.square += height * height * dx;
    sums.length += dx;
    sums.largest = std::max(sums.largest, std::abs(height));
  }
  const double weight = dx * std::min(1.0, from_end * from_end / (corner * corner));
  for (std::size_t i = 0; i < sums.product.size(); ++i) {
    const double here = weight * chebyshev(i, s);
    sums.product[i] += here * height;
    for (std::size_t j = 0; j <= i; ++j) sums.gram(i, j) += here * chebyshev(j, s);
  }
}

void sum_over_ranks(const Discretisation& d, Sums& sums) {
  for (std::size_t i = 0; i < sums.product.size(); ++i) {
    sums.product[i] = d.sum(sums.product[i]);
    for (std::size_t j = 0; j <= i; ++j) sums.gram(j, i) = sums.gram(i, j) = d.sum(sums.gram(i, j));
  }
  sums.square = d.sum(sums.square);
  sums.length = d.sum(sums.length);
  sums.largest = dealii::Utilities::MPI::max(sums.largest, d.mesh.get_communicator());
}

}  // namespace

std::size_t first_free(const FlowProblem& problem) { return slope_half_length(problem) > 0 ? 2 : 1; }

double slope_half_length(const FlowProblem& problem) {
  return std::holds_alternative<SlopeFromMoment>(problem.slope) ? problem.moving_surface->slope_half_length
                                                                : 0;
}

std::vector<double> solution_of(dealii::FullMatrix<double> A, const std::vector<double>& b) {
  A.gauss_jordan();
  dealii::Vector<double> x(b.size()), rhs(b.begin(), b.end());
  A.vmult(x, rhs);
  return {x.begin(), x.end()};
}

SurfaceMisfit surface_misfit(const FlowProblem& problem, const Discretisation& d, const State& state) {
  const SurfaceShape& shape = d.surface.value();
  const std::size_t n = shape.coefficient.size();
  Sums sums{.gram = dealii::FullMatrix<double>(n, n), .product = std::vector<double>(n)};
  std::vector<dealii::Tensor<1, 2>> u(d.side_quadrature.size());
  for_each_spring_face(problem, d, [&](const auto&, const auto& face, const NormalSpring& spring) {
    face[dealii::FEValuesExtractors::Vector(0)].get_function_values(state.solution, u);
    for (const unsigned int q : face.quadrature_point_indices()) {
      const auto x = face.quadrature_point(q);
      const Vec2 frame =
          problem.frame ? rigid_rotation(problem.frame->rotation, problem.frame->axis_offset, {x[0], x[1]})
                        : Vec2{};
      const dealii::Tensor<1, 2> velocity = u[q] + dealii::Tensor<1, 2>({frame.x, frame.z});
      const double pressed = spring.stiffness * (velocity * d.surface_normal(x, face.normal_vector(q)));
      add_point(shape, {x[0], x[1]}, pressed / (problem.density * std::cos(state.theta)), face.JxW(q), sums);
    }
  });
  sum_over_ranks(d, sums);
  SurfaceMisfit misfit{.coefficient = solution_of(sums.gram, sums.product),
                       .rms = std::sqrt(sums.square / sums.length),
                       .largest = sums.largest};
  double square = 0;
  for (std::size_t i = first_free(problem); i < n; ++i)
    for (std::size_t j = first_free(problem); j < n; ++j)
      square += misfit.coefficient[i] * sums.gram(i, j) * misfit.coefficient[j];
  misfit.resolved = std::sqrt(std::max(0.0, square) / sums.gram(0, 0));
  return misfit;
}

SurfaceResponse surface_response(Newton& newton, SolvedLevel& level) {
  // Small beyond the law's sensitivity (1 % of stress is a factor of two of shear rate), large beyond
  // rounding.
  constexpr double difference = 1e-5;
  auto& d = *level.discretisation;
  const SurfaceShape shape = d.surface.value();
  const std::size_t first = first_free(level.problem), n = shape.coefficient.size() - first;
  const auto after = [&](const SurfaceShape& changed) {
    if (!d.move_surface(level.problem, changed)) throw std::logic_error("a cell that was valid no more is");
    State state = level.state;
    d.constraints.distribute(state.solution);
    state.solution.update_ghost_values();
    return newton.corrected(level.setting, state);
  };
  newton.linearise(level.setting, level.state);
  SurfaceResponse response{.matrix = dealii::FullMatrix<double>(n, n)};
  State before = after(shape);
  const SurfaceMisfit misfit_before = surface_misfit(level.problem, d, before);
  for (std::size_t k = 0; k < n; ++k) {
    SurfaceShape changed = shape;
    changed.coefficient[first + k] += difference;
    restrain(changed, slope_half_length(level.problem));
    State here = after(changed);
    const SurfaceMisfit misfit = surface_misfit(level.problem, d, here);
    for (std::size_t i = 0; i < n; ++i)
      response.matrix(i, k) =
          (misfit.coefficient[first + i] - misfit_before.coefficient[first + i]) / difference;
    here.solution.sadd(1 / difference, -1 / difference, before.solution);
    response.of_flow.push_back(std::move(here.solution));
    response.of_theta.push_back((here.theta - before.theta) / difference);
  }
  if (!d.move_surface(level.problem, shape)) throw std::logic_error("a cell that was valid no more is");
  level.state = std::move(before);
  return response;
}

}  // namespace drumlin::continuum::fem
