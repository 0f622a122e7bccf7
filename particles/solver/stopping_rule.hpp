#pragma once
// When a contact solver stops, and what it reports. All solvers decide by StoppingTest and nowhere else.
#include <chrono>
#include <limits>

#include "coupling/core/basics/enum_names.hpp"
#include "particles/contact/residual.hpp"

namespace drumlin::particles {

enum class Status { converged, out_of_sweeps, out_of_time, not_finite };
constexpr auto names_of(Status) {
  return std::array{"converged", "out of sweeps", "out of time", "not finite"};
}

/// A solver stops when all tolerances hold, or at the first limit that it meets.
struct StoppingRule {
  double tolerance = 1e-2;                                       ///< of ContactResidual::rms
  double penetration = std::numeric_limits<double>::infinity();  ///< of ContactResidual::penetration, d
  double sinking = std::numeric_limits<double>::infinity();      ///< of ContactResidual::sinking, d
  int max_sweeps = 1000;                                         ///< at least 1
  int check_every =
      10;  ///< sweeps between two evaluations of the residual, which cost about one sweep each;
           ///< solves in strips leave out those that their steps call idle, at most three in turn
  double max_seconds =
      std::numeric_limits<double>::infinity();  ///< wall time; finite limits make a run irreproducible
  /// Asked every check_every sweeps; once true, it stays so and ends the solve as out of time.
  bool (*interrupted)() = nullptr;
};

struct [[nodiscard]] SolveReport {
  Status status = Status::out_of_sweeps;
  int sweeps = 0;
  ContactResidual residual;  ///< of the impulses returned
  double seconds = 0;        ///< wall time
};

/// What a rule leaves to a second method after a first one has spent its sweeps and seconds.
StoppingRule remaining(const StoppingRule&, const SolveReport& spent);
/// Report of a first method that worked to a tolerance of its own and after which nothing else follows: what
/// misses the tolerance of the rule ran out of sweeps.
SolveReport judged(const StoppingRule&, SolveReport);
/// Report of the second method, with the sweeps and seconds of the first added.
SolveReport together(const SolveReport& first, const SolveReport& second);

/// Applies a rule to one solve, which begins when this is made.
class StoppingTest {
 public:
  explicit StoppingTest(const StoppingRule& rule) : rule_(rule) {}

  /// Whether the residual is to be evaluated after so many sweeps.
  bool due(int sweeps) const { return sweeps >= rule_.max_sweeps || sweeps % rule_.check_every == 0; }
  /// Whether the solve ends with this residual after so many sweeps. `finite`: no sweep has made an infinity
  /// or a NaN.
  bool ends(int sweeps, const ContactResidual& residual, bool finite = true);
  /// Whether the time of the rule is over, or somebody interrupts the solve: the next residual ends it.
  bool out_of_time() const;
  /// The solve returns other impulses than the last ones, with this residual.
  void replace(const ContactResidual& residual) { report_.residual = residual; }
  /// As of the last call of ends(); its status means something only if the solve ended.
  const SolveReport& report() const { return report_; }

 private:
  using Clock = std::chrono::steady_clock;
  StoppingRule rule_;
  Clock::time_point start_ = Clock::now();
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  SolveReport report_;
};

}  // namespace drumlin::particles
