#include "apps/commands/calibrate/memory_json.hpp"

#include <nlohmann/json.hpp>

#include "coupling/documents/json_numbers.hpp"

namespace drumlin::apps {
namespace {

using Json = nlohmann::ordered_json;

Json fit_json(const coupling::MemoryFit& fit) {
  const auto coefficient = [&](double value, std::size_t j) {
    return Json{{"value", value},
                {"held", !fit.free[j]},
                {"ci99_sectors", number_or_null(fit.ci99_sectors[j])},
                {"ci99_runs", number_or_null(fit.ci99_runs[j])}};
  };
  return {{"c", coefficient(fit.law.c, coupling::memory_c)},
          {"m", coefficient(fit.law.m, coupling::memory_m)},
          {"chi", coefficient(fit.law.chi, coupling::memory_chi)},
          {"c_rho", fit.law.c_rho ? Json(*fit.law.c_rho) : Json()},
          {"converged", fit.converged},
          {"paths", fit.paths},
          {"rms", fit.rms},
          {"cost", fit.cost},
          {"correlation",
           {{"c_m", number_or_null(fit.correlation[0])},
            {"c_chi", number_or_null(fit.correlation[1])},
            {"m_chi", number_or_null(fit.correlation[2])}}}};
}

Json zone_json(const coupling::MemoryScore::Zone& zone) {
  return {{"paths", zone.paths},
          {"rms", number_or_null(zone.rms)},
          {"axes_deg", number_or_null(zone.axes_deg)},
          {"rms_without_memory", number_or_null(zone.coaxial_rms)},
          {"axes_deg_without_memory", number_or_null(zone.coaxial_axes_deg)}};
}

Json scores_json(const std::vector<coupling::MemoryScore>& scores) {
  Json json = Json::array();
  for (const coupling::MemoryScore& score : scores)
    json.push_back({{"run", score.run}, {"bed", zone_json(score.bed)}, {"flow", zone_json(score.flow)}});
  return json;
}

Json amount_json(const coupling::MemoryCalibration& found, const std::vector<coupling::RunEvidence>& runs) {
  const coupling::SampledLaw at = coupling::sampled(found.amount);
  Json json{{"points", Json::array()},
            {"rms_misfit", found.amount.fit.rms_misfit},
            {"range_of_validity", {found.amount.I_min, found.amount.I_max}},
            {"curve", {{"I", at.I}, {"value", at.value}, {"low", at.low}, {"high", at.high}}}};
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
  Json json{{"chi_range", Json::array()}, {"c_rho", Json::array()}};
  for (const coupling::LeadTrial& trial : found.leads)
    json["chi_range"].push_back({{"I_low", trial.I_low}, {"I_high", trial.I_high}, {"cost", trial.cost}});
  for (const coupling::CarriedRhoTrial& trial : found.carried) {
    const coupling::AxisMemory& law = trial.fit.law;
    json["c_rho"].push_back({{"c_rho", law.c_rho ? Json(*law.c_rho) : Json()},
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
  const auto side = [](const coupling::DilationShare::Half& half) {
    return Json{{"points", half.points},
                {"mu", number_or_null(half.mu)},
                {"dilatancy", number_or_null(half.dilatancy)}};
  };
  Json json = Json::array();
  for (const coupling::DilationShare& share : found.dilation)
    json.push_back({{"I", {share.I_from, share.I_to}},
                    {"upstream", side(share.upstream)},
                    {"downstream", side(share.downstream)},
                    {"slope", number_or_null(share.slope())}});
  return json;
}

Json amount_scores_json(const std::vector<coupling::AmountScore>& scores) {
  Json json = Json::array();
  for (const coupling::AmountScore& score : scores)
    json.push_back(
        {{"run", score.run},
         {"bed", {{"rms", number_or_null(score.bed)}, {"rms_alone", number_or_null(score.bed_alone)}}},
         {"flow", {{"rms", number_or_null(score.flow)}, {"rms_alone", number_or_null(score.flow_alone)}}}});
  return json;
}

/// null without it.
Json remembered_json(const std::optional<coupling::AmountFit>& fit) {
  if (!fit) return {};
  const auto coefficient = [](double value, double ci99) {
    return Json{{"value", value}, {"ci99_sectors", ci99}};
  };
  Json trials = Json::array();
  for (const coupling::AmountTrial& trial : fit->trials)
    trials.push_back({{"c_nu", trial.c_nu}, {"c_psi", trial.c_psi}, {"rms", trial.rms}});
  Json measured;
  if (fit->measured)
    measured = {{"coefficient", coefficient(fit->measured->coefficient, fit->measured->coefficient_ci99)},
                {"c_psi", fit->measured->c_psi},
                {"lag", fit->measured->lag},
                {"rms", fit->measured->rms}};
  return {{"swelling", coefficient(fit->law.swelling, fit->ci99_sectors[coupling::amount_swelling])},
          {"lag", coefficient(fit->law.lag, fit->ci99_sectors[coupling::amount_lag])},
          {"c_nu", fit->law.c_nu},
          {"c_psi", fit->law.c_psi},
          {"rms_misfit", fit->table.fit.rms_misfit},
          {"trials", trials},
          {"measured_dilatancy", measured},
          {"runs", amount_scores_json(fit->scores)},
          {"held_out", amount_scores_json(fit->predictions)}};
}

}  // namespace

Json memory_json(const coupling::MemoryCalibration& found, const std::vector<coupling::RunEvidence>& runs) {
  const coupling::AxisMemory& law = found.law;
  return {{"law",
           {{"c", law.c},
            {"m", law.m},
            {"chi", law.chi},
            {"c_rho", *law.c_rho},
            {"I_low", law.I_low},
            {"I_high", law.I_high}}},
          {"amount", amount_json(found, runs)},
          {"free", fit_json(found.free)},
          {"bed_alone", fit_json(found.bed_alone)},
          {"bounded", fit_json(found.bounded)},
          {"trials", trials_json(found)},
          {"runs", scores_json(found.scores)},
          {"held_out", scores_json(found.predictions)},
          {"arcs", arcs_json(found)},
          {"dilation", dilation_json(found)},
          {"remembered_amount", remembered_json(found.remembered)},
          {"from_displacements", found.from_displacements},
          {"untold", found.untold}};
}

}  // namespace drumlin::apps
