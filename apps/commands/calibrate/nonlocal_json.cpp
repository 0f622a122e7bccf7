#include "apps/commands/calibrate/nonlocal_json.hpp"

#include <fmt/format.h>

#include "apps/json/described.hpp"

namespace drumlin::apps {

using Json = nlohmann::ordered_json;

Json nonlocal_json(const coupling::NonlocalFit& found) {
  Json json{{"amplitude", found.law.amplitude},
            {"mu_s", found.law.mu_s},
            {"amplitude_ci99", found.law.amplitude_ci99},
            {"mu_s_ci99", found.law.mu_s_ci99},
            {"points", found.points},
            {"rms", found.rms},
            {"rms_bed", found.rms_bed},
            {"rms_local", found.local_rms},
            {"rms_local_bed", found.local_rms_bed},
            {"correlation_bed", found.correlation_bed},
            {"given_mu_s", Json::array()},
            {"lengths", Json::array()},
            {"untold", found.untold}};
  for (const auto& [rms, law] : found.given)
    json["given_mu_s"].push_back({{"mu_s", law.mu_s}, {"amplitude", law.amplitude}, {"rms_bed", rms}});
  for (const coupling::LengthOverFriction& length : found.lengths)
    json["lengths"].push_back({{"mu", {length.mu_from, length.mu_to}},
                               {"points", length.points},
                               {"I", length.I},
                               {"curvature", length.curvature},
                               {"xi", length.xi()}});
  return json;
}

std::string nonlocal_text(const coupling::NonlocalFit& found) {
  const auto with_interval = [](double value, const std::optional<double>& ci99) {
    return fmt::format("{:.3g}{}", value, ci99 ? fmt::format(" +- {:.2g}", *ci99) : "");
  };
  std::string text = fmt::format(
      "nonlocal fluidity with a threshold, from {} points\n"
      "  A = {}, mu_s = {} (99 %, over sectors); |s|/p of the bed {:.4f} off, without a threshold {:.4f}\n",
      found.points, with_interval(found.law.amplitude, found.law.amplitude_ci99),
      with_interval(found.law.mu_s, found.law.mu_s_ci99), found.rms_bed, found.local_rms_bed);
  for (const auto& [rms, law] : found.given)
    text += fmt::format("  mu_s = {:.2f}: A = {:.2f}, bed {:.4f} off\n", law.mu_s, law.amplitude, rms);
  text += "  measured: mu, I, lap g/g (per d^2), xi (d)\n";
  for (const coupling::LengthOverFriction& length : found.lengths)
    text += fmt::format("    {:.2f} to {:.2f}  {:.1e}  {:+.3f}  {}\n", length.mu_from, length.mu_to, length.I,
                        length.curvature, length.curvature > 0 ? fmt::format("{:.1f}", length.xi()) : "none");
  if (!found.untold.empty()) text += "  what the runs cannot tell\n";
  for (const std::string& sentence : found.untold) text += "  - " + sentence + "\n";
  return text;
}

}  // namespace drumlin::apps
