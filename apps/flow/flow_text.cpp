#include "apps/flow/flow_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "apps/output/next_step.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

// The identities, and how far the flow is from its closed form.
std::string checks_text(const FinishedFlow& flow) {
  std::string text;
  for (const Scalar& check : flow.findings.checks.scalars)
    text += fmt::format("  {:<24} {:>13.6g}\n", check.name, check.value);
  if (!flow.findings.closed_form) return text;
  const continuum::GapComparison& c = *flow.findings.closed_form;
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
  for (const continuum::ScalarLimit& s : continuum::limits_of(flow.meshes))
    text += s.limit ? fmt::format(" {} {:.6g} (order {:.1f})", s.name, s.limit->value, s.limit->order)
                    : fmt::format(" {} - (no order)", s.name);
  return text + "\n";
}

// Change of the results by k and nonlocal fluidity.
std::string plain_text(const FinishedFlow& flow) {
  if (!flow.plain) return "";
  const bool nonlocal = flow.asked.scene.effects.nonlocal.has_value();
  std::string text =
      fmt::format("  {} Picard updates of the fields that the law takes from the flow; without {}:",
                  flow.solution.report.picard_updates,
                  !flow.asked.law.k ? "nonlocal fluidity"
                  : nonlocal        ? "k and nonlocal fluidity"
                                    : "k");
  for (const Scalar& scalar : flow.plain->scalars.scalars)
    text += fmt::format(" {} {:.4g} ({:+.2g})", scalar.name, scalar.value,
                        scalar.value - flow.meshes.back().scalars.value(scalar.name));
  return text + fmt::format(", v_x off by {:.1f} % (rms over the profile)\n", 100 * flow.plain->v_x_change);
}

/// Effects by their size in this flow: those that its equations leave out, and those that they hold.
std::string neglected_text(const FinishedFlow& flow) {
  if (!flow.findings.neglected) return "";
  const continuum::NeglectedTerms& rest = *flow.findings.neglected;
  const continuum::FlowEffects& effects = flow.asked.scene.effects;
  std::string left_out, held;
  const auto add = [&](bool is_held, const std::string& words) {
    std::string& text = is_held ? held : left_out;
    text += (text.empty() ? "" : "; ") + words;
  };
  add(has_inertia(flow.asked.scene), fmt::format("inertia, {:.2g} of gravity (rms; at most {:.2g})",
                                                 rest.inertia_rms, rest.inertia_largest));
  add(effects.moving_surface.has_value(),
      fmt::format("a moving surface, {:.2g} d from the level one (rms)", rest.surface_height_rms));
  add(effects.wall_slip.has_value(),
      fmt::format("slip at the wall, along which friction of 0.95 holds {:.0f} %",
                  100 * (1 - rest.wall_friction)));
  if (rest.nonlocal)
    add(effects.nonlocal.has_value(),
        fmt::format("fluidity that spreads over 1 d, {:.2g} (rms of its ln where it flows)", *rest.nonlocal));
  return (left_out.empty() ? "" : "effects left out, by their size in this flow: " + left_out + "\n") +
         (held.empty() ? "" : "effects of the equations: " + held + "\n");
}

std::string summary_text(const fs::path& folder, const FinishedFlow& flow) {
  const double share = flow.findings.ill_posed_share();
  const continuum::FlowReport& report = flow.solution.report;
  std::string text = "seconds in";
  for (const continuum::PhaseSeconds& phase : report.phases)
    text += fmt::format("{} {} {:.1f} ({} times)", phase.name == report.phases.front().name ? "" : ",",
                        phase.name, phase.seconds, phase.times);
  text += fmt::format(
      "\n{}{}: {} iterations ({}), {:.1f} s, residual {:.1e}, ill-posed in {:.2f} % of the area{}\n",
      folder.string(), flow.asked.reduced() ? " (reduced)" : "", report.iterations, report.start,
      report.seconds, report.residual, 100 * share,
      share > 0 ? ": the flow there depends on the mesh (docs/formats/flow.md)" : "");
  if (const double beyond = flow.findings.beyond_law_share(); beyond > 0.01)
    text += fmt::format(
        "the law was measured up to I = {:.3g}; in {:.1f} % of the area I is larger, and mu there is "
        "extrapolated\n",
        flow.asked.flow_case.law_I_max, 100 * beyond);
  return text + neglected_text(flow);
}

std::string sensitivity_text(const FinishedFlow& flow) {
  if (flow.sensitivities.empty()) return "";
  std::string text = fmt::format("{:<14} {:>11}", "changes by", "value");
  for (const continuum::Sensitivity& s : flow.sensitivities) text += fmt::format(" {:>26}", s.setting);
  text += "\n";
  for (const Scalar& scalar : flow.meshes.back().scalars.scalars) {
    text += fmt::format("  {:<12} {:>11.5g}", scalar.name, scalar.value);
    for (const continuum::Sensitivity& s : flow.sensitivities)
      text +=
          s.found ? fmt::format(" {:>+26.2g}", s.changes.value(scalar.name)) : fmt::format(" {:>26}", "-");
    text += "\n";
  }
  text += fmt::format("  {:<12} {:>11}", "v_x, L2", "");
  for (const continuum::Sensitivity& s : flow.sensitivities)
    text += s.found && std::isfinite(s.profile) ? fmt::format(" {:>24.2g} %", 100 * s.profile)
                                                : fmt::format(" {:>26}", "-");
  text += fmt::format("\n  {:<12} {:>11}", "iterations", "");
  for (const continuum::Sensitivity& s : flow.sensitivities) text += fmt::format(" {:>26}", s.iterations);
  return text + "\n";
}

std::string law_band_text(const FinishedFlow& flow) {
  if (flow.law_band.draws == 0) return "";
  const continuum::LawBand& band = flow.law_band;
  std::string text = fmt::format(
      "what the law's points leave open (99 %, {} of {} laws, {} iterations, {:.1f} s):", band.found,
      band.draws, band.iterations, band.seconds);
  for (const Scalar& width : band.scalars.scalars)
    if (std::isfinite(width.value)) text += fmt::format(" {} +- {:.2g},", width.name, width.value);
  if (std::isfinite(band.profile)) text += fmt::format(" v_x +- {:.2g} % (L2)", 100 * band.profile);
  return text + "\n";
}

std::string accuracy_text(const FinishedFlow& flow) {
  if (flow.accuracy.scalars.empty()) return "";
  std::string text;
  std::vector<std::string> dominant;
  for (const continuum::ScalarAccuracy& a : flow.accuracy.scalars) {
    std::string told;
    for (const continuum::ErrorPart& part : a.parts)
      if (part.error) told += fmt::format(" {} {:.2g}", part.source, *part.error);
    if (told.empty()) continue;
    text += fmt::format("  {:<12} {:>11.5g} {:>12} {}", a.name, a.value,
                        a.error() ? fmt::format("+- {:.2g}", *a.error()) : "", told);
    if (a.by_p_min) text += fmt::format("; model: {:.2g} by 20 % of p_min", *a.by_p_min);
    if (a.by_law) text += fmt::format("{} {:.2g} by the law", a.by_p_min ? "," : "; model:", *a.by_law);
    text += "\n";
    if (!a.dominant().empty() && std::find(dominant.begin(), dominant.end(), a.dominant()) == dominant.end())
      dominant.push_back(a.dominant());
  }
  text = (text.empty() ? "accuracy: no error was estimated\n"
                       : "accuracy: estimated distance to the exact solution of the equations\n") +
         text;
  if (flow.sensitivities.empty())
    text += fmt::format(
        "  (--set solver.sensitivity=true adds the errors by eps and iteration{}: up to 1.5 times "
        "the time of the flow more)\n",
        flow.asked.scene.effects.memory ? "" : ", --law-draws 8 the interval by the law's points");
  for (const continuum::Halving& h : flow.accuracy.halvings)
    if (std::find(dominant.begin(), dominant.end(), h.source) != dominant.end())
      text += fmt::format(
          "  half of the error by {}: {}, about {:.2g} s of processor time in place of {:.2g} s\n", h.source,
          h.changes.empty() ? "one more iteration" : fmt::format("{}", fmt::join(h.changes, ", ")),
          h.cpu_seconds, flow.cpu_seconds);
  return text;
}

}  // namespace

std::string finished_text(const fs::path& folder, const FinishedFlow& flow) {
  const bool of_a_drum = std::holds_alternative<continuum::FlowDrum>(flow.asked.scene.geometry);
  return checks_text(flow) + plain_text(flow) + sensitivity_text(flow) + law_band_text(flow) +
         limits_text(flow) + summary_text(folder, flow) + accuracy_text(flow) +
         next_step("flow", of_a_drum ? Flowing::drum : Flowing::layers, Verdict::done, folder.string());
}

}  // namespace drumlin::apps
