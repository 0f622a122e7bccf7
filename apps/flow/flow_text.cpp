#include "apps/flow/flow_text.hpp"

#include <fmt/format.h>

#include "apps/flow/flow_accuracy.hpp"
#include "apps/flow/flow_sensitivity.hpp"
#include "apps/flow/law_band.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

// The identities, and how far the flow is from its closed form.
std::string checks_text(const FinishedFlow& flow) {
  std::string text;
  for (const Scalar& check : flow.findings.checks.scalars)
    text += fmt::format("  {:<24} {:>13.6g}\n", check.name, check.value);
  if (!flow.findings.closed_form) return text;
  const GapComparison& c = *flow.findings.closed_form;
  text +=
      fmt::format("  error of v_x (L2 over the gap): {:.1e} of the mesh, {:.1e} against the closed form\n",
                  c.mesh_error, c.closed_form_error);
  for (const Scalar& scalar : c.closed_form.scalars)
    text += fmt::format("  {:<24} {:>13.6g}, closed form {:.6g}\n", scalar.name,
                        flow.meshes.back().scalars.value(scalar.name), scalar.value);
  return text;
}

std::string limits_text(const FinishedFlow& flow) {
  if (flow.meshes.size() < 3) return "";
  std::string text = "on cells of no size:";
  for (const ScalarLimit& s : limits_of(flow.meshes))
    text += s.limit ? fmt::format(" {} {:.6g} (order {:.1f})", s.name, s.limit->value, s.limit->order)
                    : fmt::format(" {} - (no order)", s.name);
  return text + "\n";
}

// What leaving out k and nonlocal fluidity would have cost.
std::string plain_text(const FinishedFlow& flow) {
  if (!flow.plain) return "";
  const bool nonlocal = flow.scene.effects.nonlocal.has_value();
  std::string text =
      fmt::format("  settled in {} updates of what the law holds; without {}:", flow.solution.report.turns,
                  !flow.law.k ? "nonlocal fluidity"
                  : nonlocal  ? "k and nonlocal fluidity"
                              : "k");
  for (const Scalar& scalar : flow.plain->scalars.scalars)
    text += fmt::format(" {} {:.4g} ({:+.2g})", scalar.name, scalar.value,
                        scalar.value - flow.meshes.back().scalars.value(scalar.name));
  return text + fmt::format(", v_x off by {:.1f} % (rms over the profile)\n", 100 * flow.plain->v_x_change);
}

std::string left_out_text(const FinishedFlow& flow) {
  if (!flow.findings.left_out) return "";
  const LeftOut& rest = *flow.findings.left_out;
  const FlowEffects& effects = flow.scene.effects;
  std::string text = fmt::format(
      "left out: {}inertia {:.2g} of gravity (rms; at most {:.2g}), {}a surface that would rise by {:.2g} d "
      "(rms), {}"
      "a wall share of {:.2g} that asks for friction above 0.95",
      has_inertia(flow.scene) ? "not " : "", rest.inertia_rms, rest.inertia_largest,
      effects.moving_surface ? "not " : "", rest.surface_height_rms, effects.wall_slip ? "not " : "",
      rest.wall_friction);
  if (!effects.nonlocal && rest.nonlocal)
    text += fmt::format(", fluidity that spreads over 1 d ({:.2g}, rms of its ln where it flows)",
                        *rest.nonlocal);
  if (!effects.fabric && rest.fabric)
    text += fmt::format(", fabric that is renewed with c = 1 ({:.2g} of beta)", *rest.fabric);
  return text + "\n";
}

std::string summary_text(const fs::path& folder, const FinishedFlow& flow) {
  const double share = flow.findings.sums.ill_posed_area / flow.findings.sums.area;
  const FlowReport& report = flow.solution.report;
  std::string text = "seconds in";
  for (const PhaseSeconds& phase : report.phases)
    text += fmt::format("{} {} {:.1f} ({} times)", phase.name == report.phases.front().name ? "" : ",",
                        phase.name, phase.seconds, phase.times);
  text += fmt::format(
      "\n{}{}: {} iterations ({}), {:.1f} s, residual {:.1e}, ill-posed in {:.2f} % of the area{}\n",
      folder.string(), flow.reduced ? " (reduced)" : "", report.iterations, report.start, report.seconds,
      report.residual, 100 * share,
      share > 0 ? ": the flow there depends on the mesh (docs/formats/flow.md)" : "");
  return text + left_out_text(flow);
}

}  // namespace

std::string finished_text(const fs::path& folder, const FinishedFlow& flow) {
  return checks_text(flow) + plain_text(flow) + sensitivity_text(flow) + law_band_text(flow) +
         limits_text(flow) + summary_text(folder, flow) + accuracy_text(flow);
}

}  // namespace drumlin::apps
