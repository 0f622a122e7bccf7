// flow.vtu: apart from the rest, since deal.II's output costs a compiler as much time as all of it.
#include <deal.II/base/mpi.h>
#include <deal.II/numerics/data_out.h>
#include <deal.II/numerics/data_postprocessor.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <variant>

#include "continuum/fem/detail/point_law.hpp"
#include "continuum/fem/detail/solved_level.hpp"
#include "continuum/fem/flow_field.hpp"
#include "coupling/core/basics/inertial_number.hpp"
#include "coupling/core/files/text_file.hpp"

namespace drumlin::continuum {
namespace {

/// From the axes and units of the flow to the laboratory in SI: x to the right, y upwards, in a drum from its
/// axis.
struct Laboratory {
  Laboratory(const fem::SolvedLevel& level, double theta, const Scales& of)
      : scales(of), cosine(std::cos(theta)), sine(std::sin(theta)) {
    if (const auto* drum = std::get_if<ChordDomain>(&level.problem.domain)) origin_z = drum->axis_offset;
  }
  dealii::Point<2> place(const dealii::Point<2>& p) const {
    const double x = scales.length_m * p[0], z = scales.length_m * (p[1] - origin_z);
    return {cosine * x + sine * z, cosine * z - sine * x};
  }
  PlaneTensor turned(const PlaneTensor& t) const {
    const double cc = cosine * cosine, cs = cosine * sine, ss = sine * sine;
    return {cc * t.xx + 2 * cs * t.xz + ss * t.zz, ss * t.xx - 2 * cs * t.xz + cc * t.zz,
            cs * (t.zz - t.xx) + (cc - ss) * t.xz};
  }
  Scales scales;
  double cosine, sine, origin_z = 0;
};

// Velocity, stresses and numbers of the law at the vertices of each cell, in the laboratory.
class LaboratoryValues : public dealii::DataPostprocessor<2> {
 public:
  LaboratoryValues(const fem::SolvedLevel& level, const Laboratory& laboratory)
      : level_(level), laboratory_(laboratory) {}

  std::vector<std::string> get_names() const override {
    std::vector<std::string> names{"velocity_m_s",
                                   "velocity_m_s",
                                   "pressure_Pa",
                                   "sigma_xx_Pa",
                                   "sigma_zz_Pa",
                                   "sigma_xz_Pa",
                                   "D_magnitude_1_s",
                                   "I",
                                   "mu",
                                   "viscosity_Pa_s",
                                   "well_posedness_margin",
                                   "k",
                                   "axis_angle_deg",
                                   "beta",
                                   "fluidity_factor",
                                   "fluidity_1_s"};
    if (!level_.discretisation->has_fluidity()) names.pop_back();
    return names;
  }
  std::vector<dealii::DataComponentInterpretation::DataComponentInterpretation>
  get_data_component_interpretation() const override {
    using namespace dealii::DataComponentInterpretation;
    std::vector<DataComponentInterpretation> kinds(get_names().size(), component_is_scalar);
    kinds[0] = kinds[1] = component_is_part_of_vector;
    return kinds;
  }
  dealii::UpdateFlags get_needed_update_flags() const override {
    return dealii::update_values | dealii::update_gradients | dealii::update_quadrature_points;
  }

  void evaluate_vector_field(const dealii::DataPostprocessorInputs::Vector<2>& input,
                             std::vector<dealii::Vector<double>>& output) const override {
    const fem::HeldValues held = held_at(input);
    const double speed = laboratory_.scales.velocity_m_s(), pascal = laboratory_.scales.stress_Pa(),
                 second = laboratory_.scales.time_s;
    const bool has_fluidity = level_.discretisation->has_fluidity();
    for (std::size_t q = 0; q < output.size(); ++q) {
      const auto& u = input.solution_values[q];
      const auto& g = input.solution_gradients[q];
      const PlaneTensor D{g[0][0], g[1][1], 0.5 * (g[0][1] + g[1][0])};
      const double p = u[2], rate = magnitude(D), y = has_fluidity ? u[fem::fluidity_component] : 0;
      const auto s =
          fem::point_report(level_.problem, level_.setting,
                            {.motion = fem::motion_of(g), .D = D, .p = p, .ln_fluidity = y}, held, q);
      const PlaneTensor stress = laboratory_.turned(s.stress);
      const std::array<double, 16> values = {speed * (laboratory_.cosine * u[0] + laboratory_.sine * u[1]),
                                             speed * (laboratory_.cosine * u[1] - laboratory_.sine * u[0]),
                                             pascal * p,
                                             pascal * (p - stress.xx),
                                             pascal * (p - stress.zz),
                                             pascal * stress.xz,
                                             rate / second,
                                             inertial_number(2 * rate, s.normal),
                                             s.along / s.normal,
                                             s.viscosity * pascal * second,
                                             s.margin,
                                             s.ratio,
                                             s.angle * 180 / std::numbers::pi,
                                             s.beta,
                                             s.fluidity,
                                             std::exp(y) / second};
      std::copy_n(values.begin(), output[q].size(), output[q].begin());
    }
  }

 private:
  fem::HeldValues held_at(const dealii::DataPostprocessorInputs::Vector<2>& input) const {
    if (!level_.state.held) return {};
    const auto& d = *level_.discretisation;
    const auto cell = input.get_cell<2>();
    std::vector<dealii::Point<2>> unit_points;
    for (const auto& place : input.evaluation_points)
      unit_points.push_back(d.mapping.transform_real_to_unit_cell(cell, place));
    return fem::held_at(*level_.state.held, d, cell, unit_points);
  }
  const fem::SolvedLevel& level_;
  const Laboratory& laboratory_;
};

/// The cells of a flow, which are moved as a whole once their values are computed.
class LaboratoryCells : public dealii::DataOut<2> {
 public:
  void move(const Laboratory& to) {
    for (auto& patch : patches) {
      for (auto& vertex : patch.vertices) vertex = to.place(vertex);
      // Curved cells hold their points below their values.
      if (!patch.points_are_available) continue;
      const unsigned int x = patch.data.n_rows() - 2;
      for (unsigned int q = 0; q < patch.data.n_cols(); ++q) {
        const dealii::Point<2> moved = to.place({patch.data(x, q), patch.data(x + 1, q)});
        patch.data(x, q) = static_cast<float>(moved[0]);
        patch.data(x + 1, q) = static_cast<float>(moved[1]);
      }
    }
  }
};

}  // namespace

void FlowField::write_vtu(const std::filesystem::path& file, const Scales& scales) const {
  const Laboratory laboratory(*level_, theta(), scales);
  const LaboratoryValues values(*level_, laboratory);
  LaboratoryCells output;
  output.attach_dof_handler(level_->discretisation->unknowns);
  output.add_data_vector(level_->state.solution, values);
  output.build_patches(level_->discretisation->mapping, 2);
  output.move(laboratory);
  dealii::DataOutBase::VtkFlags flags;
  flags.print_date_and_time = false;  // the same flow gives the same bytes
  output.set_flags(flags);
  std::ostringstream text;
  output.write_vtu(text);
  const MPI_Comm ranks = level_->discretisation->mesh.get_communicator();
  const unsigned int count = dealii::Utilities::MPI::n_mpi_processes(ranks);
  if (count == 1) {
    replace_file(file, text.str());
    return;
  }
  const auto piece = [&](unsigned int rank) {
    auto name = file;
    return name.replace_extension(std::to_string(rank) + ".vtu");
  };
  replace_file(piece(dealii::Utilities::MPI::this_mpi_process(ranks)), text.str());
  if (dealii::Utilities::MPI::this_mpi_process(ranks) != 0) return;
  std::vector<std::string> pieces;
  for (unsigned int rank = 0; rank < count; ++rank) pieces.push_back(piece(rank).filename().string());
  std::ostringstream record;
  output.write_pvtu_record(record, pieces);
  auto parallel = file;
  replace_file(parallel.replace_extension(".pvtu"), record.str());
}

}  // namespace drumlin::continuum
