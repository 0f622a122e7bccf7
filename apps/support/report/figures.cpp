#include <fmt/format.h>

#include <cstdint>
#include <set>
#include <utility>

#include "apps/support/html.hpp"
#include "apps/support/report/sections.hpp"
#include "coupling/exchange/text_file.hpp"

namespace drumlin::apps {

namespace {

struct KnownFigure {
  const char* name;
  ReportSection section;
  const char* caption;
};

constexpr const char* how_to_read_maps =
    " Above, both sides on one colour scale; below left second minus first, below right the same in half "
    "widths of the first side's 99 % interval: beyond +-1 the difference is more than its noise. Thin lines "
    "bound the zones (flowing above, static below).";

const KnownFigure known[] = {
    {"drums", ReportSection::maps,
     "Speed in the frame of the drum, on one colour scale: on the left the grains of the last snapshot, on "
     "the right the mean flow of the second side. Colours should meet at the same places."},
    {"maps_speed", ReportSection::maps, "Speed, logarithmic."},
    {"maps_shear_rate", ReportSection::maps,
     "Shear rate, logarithmic. White below: the particles' interval leaves its sign open."},
    {"maps_pressure", ReportSection::maps, "Pressure, the mean of the normal stresses."},
    {"maps_sigma_xz", ReportSection::maps, "Shear stress on planes along the surface."},
    {"maps_mu", ReportSection::maps, "Friction: shear stress over pressure, both invariants of the stress."},
    {"maps_axis_angle", ReportSection::maps,
     "Angle from the axis of fastest shortening to that of the greatest pressure. A law with one coefficient "
     "of friction makes it zero."},
    {"velocity", ReportSection::centre,
     "Velocity along the surface, linear and logarithmic, and across it. The band is the particles' 99 % "
     "interval; the continuum should stay inside. Dashed: surface, dotted: foot of the flowing layer, grey: "
     "not judged."},
    {"shear_rate", ReportSection::centre,
     "Shear rate, linear and logarithmic. Where the band reaches zero its sign is not known; the slope of "
     "the "
     "logarithm below the dotted line is one over the decay length."},
    {"stresses", ReportSection::centre,
     "Stresses and pressure, compression positive. A straight line is the weight of what lies above."},
    {"ratios", ReportSection::centre,
     "Inertial number, the two stress ratios and the angle between the axes of stress and strain rate over "
     "depth. The law ties mu to I; k and the angle show what it leaves out."},
    {"friction", ReportSection::centre,
     "Stress ratio over inertial number, layer by layer: where the two sides part, the law or its validity "
     "does, not the flow."},
    {"slices", ReportSection::slices,
     "Narrow slices from upstream (left) to downstream (right), each counted from the particles' surface "
     "there. Differences that change sign along the row come from what the flow carries along."},
};

constexpr const char* accuracy_caption =
    "What accuracy costs: errors against a finer reference over seconds, for other settings of the solver; "
    "lower and further left is better, the scene's own setting is marked. Recorded on this repository's "
    "drum, data/cost/";
constexpr const char* effects_caption =
    "Price list of the effects: what each one, alone, changes in results and in seconds. Recorded on this "
    "repository's drum, data/cost/";

/// Pictures of the records of costs, cost_accuracy_NAME.png and cost_effects_NAME.png, by name.
void add_cost_figures(const std::filesystem::path& folder, std::vector<ReportFigure>& figures) {
  std::set<std::filesystem::path> pictures;
  if (std::filesystem::is_directory(folder))
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (entry.path().extension() == ".png") pictures.insert(entry.path());
  for (const auto& [prefix, caption] :
       {std::pair("cost_accuracy_", accuracy_caption), std::pair("cost_effects_", effects_caption)})
    for (const auto& png : pictures) {
      const std::string stem = png.stem().string();
      if (stem.starts_with(prefix))
        figures.push_back(
            {png, caption + stem.substr(std::string(prefix).size()) + ".json.", ReportSection::costs});
    }
}

}  // namespace

std::string base64(const std::string& bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::vector<ReportFigure> figures_in(const std::filesystem::path& folder) {
  std::vector<ReportFigure> figures;
  for (const KnownFigure& figure : known) {
    const std::filesystem::path png = folder / (std::string(figure.name) + ".png");
    if (!std::filesystem::exists(png)) continue;
    const bool is_sheet = std::string(figure.name).starts_with("maps_");
    figures.push_back(
        {png, std::string(figure.caption) + (is_sheet ? how_to_read_maps : ""), figure.section});
  }
  add_cost_figures(folder, figures);
  return figures;
}

namespace report {

std::string figures_of(const std::vector<ReportFigure>& figures, ReportSection section) {
  std::string text;
  for (const auto& figure : figures)
    if (figure.section == section)
      text += fmt::format(
          "<figure><img alt=\"{0}\" "
          "src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
          escaped(figure.caption), base64(file_text(figure.png)));
  return text;
}

}  // namespace report

}  // namespace drumlin::apps
