#include "continuum/fem/detail/surface_iteration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum::fem {
namespace {

using Response = dealii::FullMatrix<double>;  // of the misfit to the shape

std::vector<double> free_part(const FlowProblem& problem, const std::vector<double>& coefficient) {
  return {coefficient.begin() + static_cast<long>(first_free(problem)), coefficient.end()};
}

// The shape after a change of its free coefficients.
SurfaceShape changed(const FlowProblem& problem, SurfaceShape shape, const std::vector<double>& step) {
  for (std::size_t i = 0; i < step.size(); ++i) shape.coefficient[first_free(problem) + i] += step[i];
  restrain(shape, slope_half_length(problem));
  return shape;
}

// Broyden's update: the smallest change of the response that explains `answer` to `step`.
void correct(Response& response, const std::vector<double>& step, const std::vector<double>& answer) {
  double square = 0;
  for (const double s : step) square += s * s;
  for (std::size_t i = 0; i < step.size(); ++i) {
    double missing = answer[i];
    for (std::size_t j = 0; j < step.size(); ++j) missing -= response(i, j) * step[j];
    for (std::size_t j = 0; j < step.size(); ++j) response(i, j) += missing * step[j] / square;
  }
}

constexpr double largest_step = 8;  // d

// A bound of the height of a step, d.
double size_of(const std::vector<double>& step) {
  double size = 0;
  for (const double s : step) size += std::abs(s);
  return size;
}

// Newton's step on the shape, no higher than `largest_step` anywhere.
std::vector<double> step_of(const FlowProblem& problem, const Response& response,
                            const SurfaceMisfit& misfit) {
  std::vector<double> step = solution_of(response, free_part(problem, misfit.coefficient));
  const double cut = std::min(1.0, largest_step / size_of(step));
  for (double& s : step) s *= -cut;
  return step;
}

// One flow with the surface after a step, from where the response puts it, but for far steps. False, where
// cells or Newton's method fail.
bool solve_moved(const SurfaceSolver& solver, SolvedLevel& level, const SurfaceShape& shape,
                 const std::vector<double>& step, const SurfaceResponse& response, Settling settling) {
  auto& d = *level.discretisation;
  if (!d.move_surface(level.problem, shape)) return false;
  if (size_of(step) < 0.5 * largest_step)
    for (std::size_t k = 0; k < step.size(); ++k) {
      level.state.solution.add(step[k], response.of_flow[k]);
      level.state.theta += step[k] * response.of_theta[k];
    }
  d.constraints.distribute(level.state.solution);
  level.state.solution.update_ghost_values();
  return solver.solve(*solver.newton(), settling);
}

class Iteration {
 public:
  Iteration(const SurfaceSolver& solver, SolvedLevel& level, int mesh, FlowReport& report, double tolerance)
      : solver_(solver),
        level_(level),
        mesh_(mesh),
        report_(report),
        tolerance_(tolerance),
        settling_(solver.first),
        now_(misfit()) {
    record(0, 0);
  }
  const SurfaceMisfit& now() const { return now_; }
  bool done() const { return now_.resolved <= tolerance_ && settling_ != Settling::loose; }

  // One step that lessens the misfit, or settles what presses little enough; false if none is found.
  bool step() {
    if (now_.resolved <= tolerance_) return settle(Settling::whole);
    if (response_ && try_step(1)) return true;
    if (interrupted() || !form_response()) return false;
    for (double share = 1; share > 0.05; share *= 0.5) {
      if (try_step(share)) return true;
      if (interrupted()) return false;
    }
    response_.reset();
    if (level_.problem.memory) return settling_ != Settling::fine && settle(Settling::fine);
    return settling_ == Settling::loose && settle(Settling::whole);
  }

 private:
  SurfaceMisfit misfit() const {
    return surface_misfit(level_.problem, *level_.discretisation, level_.state);
  }
  bool interrupted() const { return report_.interrupted; }

  bool settle(Settling how) {
    const int iterations = report_.iterations;
    if (!solver_.solve(*solver_.newton(), how)) return false;
    settling_ = how;
    now_ = misfit();
    record(0, report_.iterations - iterations);
    return true;
  }

  bool form_response() {
    const SurfaceShape shape = level_.discretisation->surface.value();
    try {
      response_ = surface_response(*solver_.newton(), level_);
    } catch (const NotConvergedError& error) {
      report_.failure = error.what();
      put_back(shape);
      return false;
    }
    now_ = misfit();
    return true;
  }

  // Some shapes take away all that they can resolve, while much presses on them that they cannot.
  bool lessens(const SurfaceMisfit& next) const {
    constexpr double most_growth = 1.5;  // of what presses in all, per step
    return next.resolved < now_.resolved && next.rms <= most_growth * now_.rms;
  }

  // Leaves mesh and state as they were where the step is none.
  bool try_step(double share) {
    const FlowProblem& problem = level_.problem;
    const SurfaceShape shape = level_.discretisation->surface.value();
    const State before = level_.state;
    const int iterations = report_.iterations;
    std::vector<double> step = step_of(problem, response_->matrix, now_);
    for (double& s : step) s *= share;
    const Settling settling = problem.memory ? settling_ : Settling::whole;
    if (solve_moved(solver_, level_, changed(problem, shape, step), step, *response_, settling)) {
      const SurfaceMisfit next = misfit();
      if (lessens(next)) {
        std::vector<double> answer = free_part(problem, next.coefficient);
        for (std::size_t i = 0; i < answer.size(); ++i)
          answer[i] -= now_.coefficient[first_free(problem) + i];
        correct(response_->matrix, step, answer);
        // One that explains so little is none to go on with.
        if (next.resolved > 0.5 * now_.resolved) response_.reset();
        now_ = next;
        settling_ = settling;
        record(share, report_.iterations - iterations);
        return true;
      }
    }
    level_.state = before;
    put_back(shape);
    return false;
  }

  void put_back(const SurfaceShape& shape) {
    if (!level_.discretisation->move_surface(level_.problem, shape))
      throw std::logic_error("cells that were valid are no more");
  }

  void record(double share, int iterations) {
    const SurfaceShape& shape = level_.discretisation->surface.value();
    report_.surface_steps.push_back(
        {mesh_, share, largest_height(shape), now_.resolved, now_.rms, now_.largest, iterations});
    if (solver_.stepped) solver_.stepped(report_.surface_steps.back());
  }

  const SurfaceSolver& solver_;
  SolvedLevel& level_;
  int mesh_;
  FlowReport& report_;
  double tolerance_;
  Settling settling_;  // of the state
  SurfaceMisfit now_;
  std::optional<SurfaceResponse> response_;
};

}  // namespace

bool solve_surface(const SurfaceSolver& solver, SolvedLevel& level, int mesh, FlowReport& report) {
  const MovingSurface& effect = level.problem.moving_surface.value();
  const double tolerance = std::max(solver.tolerance, effect.tolerance);
  Iteration iteration(solver, level, mesh, report, tolerance);
  for (int step = 0; !iteration.done(); ++step) {
    const std::string state =
        fmt::format("moving surface, mesh {}: {:.3g} d (rms) still press on it after {} steps", mesh,
                    iteration.now().resolved, step);
    if (step == effect.max_steps) {
      report.failure = state;
      return false;
    }
    if (iteration.step()) continue;
    if (!report.interrupted)
      report.failure = state + ", and no step lessens that" +
                       (report.failure.empty() ? "" : " (last failure: " + report.failure + ")");
    return false;
  }
  return true;
}

}  // namespace drumlin::continuum::fem
