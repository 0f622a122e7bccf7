#include "apps/commands/calibrate/memory_json.hpp"

#include "apps/commands/calibrate/law_json.hpp"

namespace drumlin::coupling {
DRUMLIN_DESCRIBED(AxisMemory, c, m, chi, c_rho, I_low, I_high)
DRUMLIN_DESCRIBED(MemoryScore::Zone, paths, rms, axes_deg, rms_without_memory, axes_deg_without_memory)
DRUMLIN_DESCRIBED(MemoryScore, run, bed, flow)
DRUMLIN_DESCRIBED(LeadTrial, I_low, I_high, cost)
DRUMLIN_DESCRIBED(DilationShare::Half, points, mu, dilatancy)
DRUMLIN_DESCRIBED(AmountTrial, c_nu, c_psi, creep_ratio, rms)
}  // namespace drumlin::coupling

namespace drumlin::apps {
namespace {

using Json = nlohmann::ordered_json;

Json fit_json(const coupling::MemoryFit& fit) {
  const auto coefficient = [&](double value, std::size_t j) {
    return Json{{"value", value},
                {"held", !fit.free[j]},
                {"ci99_sectors", fit.ci99_sectors[j]},
                {"ci99_runs", fit.ci99_runs[j]}};
  };
  return {{"c", coefficient(fit.law.c, coupling::memory_c)},
          {"m", coefficient(fit.law.m, coupling::memory_m)},
          {"chi", coefficient(fit.law.chi, coupling::memory_chi)},
          {"c_rho", fit.law.c_rho},
          {"converged", fit.converged},
          {"paths", fit.paths},
          {"rms", fit.rms},
          {"cost", fit.cost},
          {"correlation",
           {{"c_m", fit.correlation[0]}, {"c_chi", fit.correlation[1]}, {"m_chi", fit.correlation[2]}}}};
}

Json amount_json(const coupling::MemoryCalibration& found, const std::vector<coupling::RunEvidence>& runs) {
  Json json{{"points", Json::array()},
            {"rms_misfit", found.amount.fit.rms_misfit},
            {"range_of_validity", {found.amount.I_min, found.amount.I_max}},
            {"curve", coupling::sampled(found.amount)}};
  json["bed_line"] = Json();
  if (found.bed_line)
    json["bed_line"] = {{"a", found.bed_line->law[0]},
                        {"b", found.bed_line->law[1]},
                        {"rms_misfit", found.bed_line->rms_misfit},
                        {"points", found.bed_line->points}};
  for (const coupling::RunEvidence& run : runs) {
    std::vector<double> I, amount;
    for (const coupling::FrictionPoint& point : coupling::amounts(run.amount_blocks)) {
      I.push_back(point.I);
      amount.push_back(point.mu);
    }
    json["points"].push_back({{"run", run.name}, {"I", I}, {"amount", amount}});
  }
  return json;
}

Json trials_json(const coupling::MemoryCalibration& found) {
  Json json{{"chi_range", found.leads}, {"c_rho", Json::array()}};
  for (const coupling::CarriedRhoTrial& trial : found.carried) {
    const coupling::AxisMemory& law = trial.fit.law;
    json["c_rho"].push_back({{"c_rho", law.c_rho},
                             {"c", law.c},
                             {"chi", law.chi},
                             {"rms", trial.fit.rms},
                             {"cost", trial.fit.cost},
                             {"told_apart", trial.told_apart}});
  }
  return json;
}

Json arcs_json(const coupling::MemoryCalibration& found) {
  Json json = Json::array();
  for (const coupling::AxesOnArc& arc : found.arcs)
    json.push_back({{"radius", {arc.radius_from, arc.radius_to}},
                    {"angle_deg", arc.angle_deg},
                    {"stress_deg", arc.stress_deg},
                    {"law_deg", arc.law_deg},
                    {"strain_rate_deg", arc.rate_deg},
                    {"amount", arc.amount},
                    {"law_amount", arc.law_amount}});
  return json;
}

Json dilation_json(const coupling::MemoryCalibration& found) {
  Json json = Json::array();
  for (const coupling::DilationShare& share : found.dilation)
    json.push_back({{"I", {share.I_from, share.I_to}},
                    {"upstream", share.upstream},
                    {"downstream", share.downstream},
                    {"slope", share.slope()}});
  return json;
}

Json amount_scores_json(const std::vector<coupling::AmountScore>& scores) {
  Json json = Json::array();
  for (const coupling::AmountScore& score : scores)
    json.push_back({{"run", score.run},
                    {"bed", {{"rms", score.bed}, {"rms_alone", score.bed_alone}}},
                    {"flow", {{"rms", score.flow}, {"rms_alone", score.flow_alone}}}});
  return json;
}

/// null without it.
Json remembered_json(const std::optional<coupling::AmountFit>& fit) {
  if (!fit) return {};
  const auto coefficient = [](double value, double ci99) {
    return Json{{"value", value}, {"ci99_sectors", ci99}};
  };
  Json measured;
  if (fit->measured)
    measured = {{"coefficient", coefficient(fit->measured->coefficient, fit->measured->coefficient_ci99)},
                {"c_psi", fit->measured->c_psi},
                {"lag", fit->measured->lag},
                {"rms", fit->measured->rms}};
  Json creep;
  if (fit->law.creep)
    creep = {{"slope", coefficient(fit->law.creep->slope, fit->ci99_sectors[coupling::amount_creep])},
             {"ratio", fit->law.creep->ratio}};
  return {{"swelling", coefficient(fit->law.swelling, fit->ci99_sectors[coupling::amount_swelling])},
          {"lag", coefficient(fit->law.lag, fit->ci99_sectors[coupling::amount_lag])},
          {"creep", creep},
          {"own_weight", fit->law.own_weight},
          {"c_nu", fit->law.c_nu},
          {"c_psi", fit->law.c_psi},
          {"rms_misfit", fit->table.fit.rms_misfit},
          {"trials", fit->trials},
          {"measured_dilatancy", measured},
          {"runs", amount_scores_json(fit->scores)},
          {"held_out", amount_scores_json(fit->predictions)}};
}

}  // namespace

Json memory_json(const coupling::MemoryCalibration& found, const std::vector<coupling::RunEvidence>& runs) {
  return {{"law", found.law},
          {"amount", amount_json(found, runs)},
          {"free", fit_json(found.free)},
          {"bed_alone", fit_json(found.bed_alone)},
          {"bounded", fit_json(found.bounded)},
          {"trials", trials_json(found)},
          {"runs", found.scores},
          {"held_out", found.predictions},
          {"arcs", arcs_json(found)},
          {"dilation", dilation_json(found)},
          {"remembered_amount", remembered_json(found.remembered)},
          {"from_displacements", found.from_displacements},
          {"untold", found.untold}};
}

}  // namespace drumlin::apps
