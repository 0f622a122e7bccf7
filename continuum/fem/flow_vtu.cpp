// flow.vtu: apart from the rest, since deal.II's output costs a compiler as much time as all of it.
#include <deal.II/base/mpi.h>
#include <deal.II/numerics/data_out.h>
#include <deal.II/numerics/data_postprocessor.h>

#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "continuum/fem/detail/point_law.hpp"
#include "continuum/fem/detail/solved_level.hpp"
#include "continuum/fem/flow_field.hpp"
#include "coupling/common/files/text_file.hpp"

namespace drumlin::continuum {
namespace {

// Stresses and numbers of the law at the vertices of each cell.
class LawOutput : public dealii::DataPostprocessor<2> {
 public:
  explicit LawOutput(const fem::SolvedLevel& level) : level_(level) {}

  std::vector<std::string> get_names() const override {
    return {"pressure",
            "sigma_xx",
            "sigma_zz",
            "sigma_xz",
            "D_magnitude",
            "I",
            "mu",
            "viscosity",
            "well_posedness_margin",
            "k",
            "axis_angle_deg",
            "beta",
            "fluidity_factor"};
  }
  std::vector<dealii::DataComponentInterpretation::DataComponentInterpretation>
  get_data_component_interpretation() const override {
    return std::vector<dealii::DataComponentInterpretation::DataComponentInterpretation>(
        get_names().size(), dealii::DataComponentInterpretation::component_is_scalar);
  }
  dealii::UpdateFlags get_needed_update_flags() const override {
    return dealii::update_values | dealii::update_gradients | dealii::update_quadrature_points;
  }

  void evaluate_vector_field(const dealii::DataPostprocessorInputs::Vector<2>& input,
                             std::vector<dealii::Vector<double>>& output) const override {
    const fem::HeldValues held = held_at(input);
    for (std::size_t q = 0; q < output.size(); ++q) {
      const auto& g = input.solution_gradients[q];
      const PlaneTensor D{g[0][0], g[1][1], 0.5 * (g[0][1] + g[1][0])};
      const double p = input.solution_values[q][2], rate = magnitude(D);
      const double y =
          level_.discretisation->has_fluidity() ? input.solution_values[q][fem::fluidity_component] : 0;
      const auto s =
          fem::point_report(level_.problem, level_.setting, {.D = D, .p = p, .ln_fluidity = y}, held, q);
      const std::array<double, 13> values = {p,
                                             p - s.stress.xx,
                                             p - s.stress.zz,
                                             s.stress.xz,
                                             rate,
                                             2 * rate / std::sqrt(s.normal),
                                             s.along / s.normal,
                                             s.viscosity,
                                             s.margin,
                                             s.ratio,
                                             s.angle * 180 / std::numbers::pi,
                                             s.beta,
                                             s.fluidity};
      std::copy(values.begin(), values.end(), output[q].begin());
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
};

}  // namespace

void FlowField::write_vtu(const std::filesystem::path& file) const {
  using Interpretation = dealii::DataComponentInterpretation::DataComponentInterpretation;
  const LawOutput law(*level_);
  dealii::DataOut<2> output;
  output.attach_dof_handler(level_->discretisation->unknowns);
  std::vector<std::string> names{"velocity", "velocity", "p"};
  std::vector<Interpretation> kinds{Interpretation::component_is_part_of_vector,
                                    Interpretation::component_is_part_of_vector,
                                    Interpretation::component_is_scalar};
  if (has_fluidity()) {
    names.emplace_back("ln_fluidity");
    kinds.push_back(Interpretation::component_is_scalar);
  }
  output.add_data_vector(level_->state.solution, names, dealii::DataOut<2>::type_dof_data, kinds);
  output.add_data_vector(level_->state.solution, law);
  output.build_patches(level_->discretisation->mapping, 2);
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
