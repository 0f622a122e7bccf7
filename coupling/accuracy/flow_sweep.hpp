#pragma once
// A sweep over the settings of a continuum flow: its points, and the errors of each.
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coupling/accuracy/sweep_axes.hpp"
#include "coupling/accuracy/work_point.hpp"

namespace drumlin::coupling {

/// What decides how accurately a flow is solved.
struct FlowSettings {
  int levels = 0;        ///< number of meshes; the coarsest is that of the scene
  double eps = 0;        ///< regularisation of the shear rate, sqrt(g/d)
  double tolerance = 0;  ///< of Newton's method
  bool operator==(const FlowSettings&) const = default;
};
std::string name_of(const FlowSettings& settings);

/// The settings as changes of the scene's keys, as for --set. `standard` are the scene's own, `surface_cell`
/// its cell at the surface (d): it halves with each further mesh.
std::vector<std::string> changes_of(const FlowSettings& settings, const FlowSettings& standard,
                                    double surface_cell);

/// The points along which one setting is varied and the others are the scene's own.
struct SweepCurve {
  std::string axis;                  ///< mesh, eps, tolerance
  std::vector<FlowSettings> points;  ///< from the coarsest to the finest
};

/// What flows can be swept over.
const std::vector<std::string>& flow_axes();
/// One curve through the scene for each axis. Throws InputError for values out of range.
std::vector<SweepCurve> sweep_curves(const FlowSettings& standard, const std::vector<SweepAxis>& axes);
/// Finer than every point in mesh and eps where they are varied: what errors are measured against.
FlowSettings reference_settings(const FlowSettings& standard, const std::vector<SweepCurve>& curves);

/// Distances of a flow across a gap to its closed form.
struct ClosedFormErrors {
  double v_x = 0;        ///< rms of the profile, relative
  double v_x_mesh = 0;   ///< the same against the exact flow of the regularised law
  NamedNumbers scalars;  ///< of the closed form
};

/// The numbers of a solved flow that a sweep compares.
struct FlowNumbers {
  NamedNumbers scalars;
  std::vector<double> v_x;  ///< over the layers of its profile, NaN where there is no material
  std::optional<ClosedFormErrors> closed_form;
};

/// Differences of all scalars relative to those of `reference` (without those that are 0 there), then "v_x":
/// rms of the difference of the profiles over rms of the reference's; NaN where their layers differ in
/// number.
NamedNumbers relative_differences(const FlowNumbers& flow, const FlowNumbers& reference);

/// A point of the sweep.
struct SweptFlow {
  FlowSettings settings;
  std::vector<std::string> axes;       ///< the curves on which it lies
  std::optional<FlowNumbers> numbers;  ///< nothing where it did not converge
};

struct FlowErrors {
  NamedNumbers errors;  ///< against the reference, or the closed form
  /// By axis, against the finest point of that curve: what this setting does with the others fixed.
  std::vector<std::pair<std::string, NamedNumbers>> alone;
};

/// The errors of each point; without a `reference` all of them have a closed form. Empty where a point did
/// not converge.
std::vector<FlowErrors> flow_errors(std::span<const SweptFlow> points, const std::vector<SweepCurve>& curves,
                                    const std::optional<FlowNumbers>& reference);
/// The names of what there are errors of, in the order of their first appearance.
std::vector<std::string> quantities_of(std::span<const FlowErrors> errors);

}  // namespace drumlin::coupling
