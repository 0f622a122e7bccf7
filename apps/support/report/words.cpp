#include "apps/support/report/words.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/support/html.hpp"

namespace drumlin::apps::report {

namespace {

using Words = std::map<std::string, std::string>;

const Words& words() {
  static const Words names{{"theta_deg", "slope &theta; (deg)"},
                           {"Q", "flow rate Q"},
                           {"H", "depth of the flowing layer H (d)"},
                           {"lambda", "decay length &lambda; (d)"},
                           {"lambda_same_window", "&lambda; where the particles&rsquo; is read (d)"},
                           {"shear_rate", "shear rate of the flowing layer"},
                           {"I_th", "inertial number at the interface"},
                           {"nu_bulk", "volume fraction of the bulk"},
                           {"mu_a", "a of &mu; = a + b ln I"},
                           {"mu_b", "b of &mu; = a + b ln I"},
                           {"k_flowing", "k in the flowing layer"},
                           {"spin_over_half_vorticity", "spin over half the vorticity"},
                           {"dv_over_shear", "velocity fluctuation over shear rate"},
                           {"domega_over_shear", "spin fluctuation over shear rate"},
                           {"linear_layer_share", "0.4 &middot; shear rate &middot; H&sup2; / Q"},
                           {"v_x", "velocity v<sub>x</sub>"},
                           {"v_z", "velocity v<sub>z</sub>"},
                           {"sigma_zz", "&sigma;<sub>zz</sub>"},
                           {"sigma_xz", "&sigma;<sub>xz</sub>"},
                           {"sigma_xx", "&sigma;<sub>xx</sub>"},
                           {"p", "pressure p"},
                           {"mu", "&mu;"},
                           {"k", "k = &sigma;<sub>xx</sub>/&sigma;<sub>zz</sub>"},
                           {"log10_I", "log<sub>10</sub> I (decades)"},
                           {"log10_shear_rate", "log<sub>10</sub> of the shear rate (decades)"},
                           {"axis_angle_deg", "angle between the axes of stress and strain rate (deg)"}};
  return names;
}

const Words& meanings() {
  static const Words names{
      {"theta_deg", "the whole surface lies at another slope: friction as a whole is off"},
      {"Q", "more or less material flows than fill and rotation allow: a fault, not physics"},
      {"H", "the flowing layer is thicker or thinner than that of the grains"},
      {"lambda", "the creep below the flowing layer fades over another depth than among the grains"},
      {"v_x", "the flowing layer moves at another speed"},
      {"log10_shear_rate", "the slow creep below the flowing layer runs at another rate"},
      {"sigma_zz", "the weight is carried otherwise; with the right density that should not happen"},
      {"sigma_xz", "the shear stress is another one; where hardly anything moves, the law does not fix it"},
      {"sigma_xx",
       "the stress along the surface is another one: the ratio of normal stresses is not in the "
       "law, or not enough of it"},
      {"axis_angle_deg",
       "among the grains the axes of stress and strain rate part, which a law with one "
       "coefficient of friction cannot follow"}};
  return names;
}

}  // namespace

std::string words_for(const std::string& name) {
  const auto found = words().find(name);
  return found == words().end() ? escaped(name) : found->second;
}

std::string short_words_for(const std::string& name) {
  static const Words names{{"v_x", "v<sub>x</sub>"},
                           {"v_z", "v<sub>z</sub>"},
                           {"p", "p"},
                           {"k", "k"},
                           {"log10_I", "log<sub>10</sub> I"},
                           {"log10_shear_rate", "log<sub>10</sub> shear rate"},
                           {"axis_angle_deg", "axis angle (deg)"}};
  const auto found = names.find(name);
  return found == names.end() ? words_for(name) : found->second;
}

std::string meaning_of_a_miss(const std::string& quantity) {
  const auto found = meanings().find(quantity);
  return found == meanings().end() ? std::string() : found->second;
}

bool is_known(const Json& value) { return value.is_number() && std::isfinite(value.get<double>()); }

std::string shown(const Json& value) {
  return is_known(value) ? fmt::format("{:.4g}", value.get<double>()) : std::string("&ndash;");
}

std::string shown_measurement(const Json& measured) {
  if (!measured.is_object()) return shown(measured);
  std::string text = shown(measured.value("value", Json()));
  const Json interval = measured.value("ci99", Json());
  return is_known(interval) ? text + fmt::format(" &plusmn; {:.2g}", interval.get<double>()) : text;
}

std::string percent(const Json& share) {
  return is_known(share) ? fmt::format("{:.0f} %", 100 * share.get<double>()) : std::string("&ndash;");
}

std::string percent_fine(const Json& share) {
  return is_known(share) ? fmt::format("{:.1f} %", 100 * share.get<double>()) : std::string("&ndash;");
}

double value_of(const Json& measured) {
  const Json value = measured.is_object() ? measured.value("value", Json()) : measured;
  return is_known(value) ? value.get<double>() : std::nan("");
}

std::string difference(double from, double to) {
  if (std::isnan(from) || std::isnan(to)) return "&ndash;";
  if (from == 0) return fmt::format("{:+.3g}", to - from);
  return fmt::format("{:+.3g} ({:+.1f} %)", to - from, 100 * (to - from) / std::abs(from));
}

std::string target_name(const Json& target) {
  std::string name = words_for(target["quantity"].get<std::string>());
  if (target.contains("zone")) name += ", " + escaped(target["zone"].get<std::string>());
  return name;
}

std::string outcome_cell(const std::string& outcome) {
  return fmt::format("<td class=\"{}\">{}</td>", escaped(outcome),
                     outcome == "not_measured" ? "not measured" : escaped(outcome));
}

bool has_relative_error(const std::string& field) {
  return !field.starts_with("log10_") && field != "axis_angle_deg";
}

std::string side_name(const Json& comparison, const std::string& side) {
  const auto text = [&](const std::string& which, const char* key) {
    return escaped(comparison[which].value(key, std::string(which)));
  };
  if (text("particles", "kind") != text("continuum", "kind")) return text(side, "kind");
  return text(side, "kind") + " " + text(side, "name");
}

}  // namespace drumlin::apps::report
