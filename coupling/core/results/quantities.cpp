#include "coupling/core/results/quantities.hpp"

namespace drumlin {
namespace {

constexpr const char *speed = "sqrt(g d)", *rate = "sqrt(g/d)", *stress = "rho0 g d",
                     *stress_slope = "rho0 g", *plain = "1", *per_length = "1/d";

struct Quantity {
  std::string_view name;
  const char *unit, *meaning;
};

constexpr Quantity quantities[] = {
    {"v_x", speed, "mean velocity along x"},
    {"v_z", speed, "mean velocity along z"},
    {"v_t", speed, "mean velocity along the tangent, clockwise"},
    {"v_r", speed, "mean velocity outwards"},
    {"d_v_x_dx", rate, "slope of v_x over x"},
    {"d_v_x_dz", rate, "slope of v_x over z"},
    {"d_v_z_dx", rate, "slope of v_z over x"},
    {"d_v_z_dz", rate, "slope of v_z over z"},
    {"D_xx", rate, "rate of strain along x"},
    {"D_zz", rate, "rate of strain along z"},
    {"D_xz", rate, "half of d v_x/dz + d v_z/dx"},
    {"dilation", rate, "divergence of the velocity"},
    {"shear_rate", rate, "slope of v_x over z; in rings r times that of v_t/r over r"},
    {"strain_rate", rate, "2 sqrt(D:D/2) of the rate of strain D"},
    {"half_vorticity", rate, "half of d v_x/dz - d v_z/dx; in rings of the curl, clockwise"},
    {"omega", rate, "mean spin of the grains"},
    {"nu", plain, "volume fraction"},
    {"density", "rho0", "mass per area"},
    {"number_density", "1/d^2", "grains per area"},
    {"sigma_xx", stress, "normal stress along x, compression positive"},
    {"sigma_zz", stress, "normal stress along z, compression positive"},
    {"sigma_xz", stress, "traction of what is above on what is below, along x"},
    {"sigma_zx", stress, "sigma_xz with its axes exchanged"},
    {"sigma_tt", stress, "normal stress along the tangent, compression positive"},
    {"sigma_rr", stress, "normal stress along r, compression positive"},
    {"sigma_rt", stress, "traction of what is outside on what is inside, clockwise"},
    {"sigma_rotational", stress, "energy of the spins per area"},
    {"p", stress, "pressure, (sigma_xx + sigma_zz)/2"},
    {"tau", stress, "half the difference of the principal stresses"},
    {"I", plain, "inertial number"},
    {"mu", plain, "sigma_xz/sigma_zz; in rings sigma_rt/sigma_rr; in maps tau/p"},
    {"k", plain, "sigma_xx/sigma_zz; in rings sigma_tt/sigma_rr"},
    {"axis_angle_deg", "deg", "from the axis of the fastest shortening to that of the greatest pressure"},
    {"I_law", plain, "inertial number of the law"},
    {"mu_law", plain, "friction coefficient of the law"},
    {"k_law", plain, "k of the law"},
    {"viscosity", "rho0 d sqrt(g d)", "of the stress along the rate of strain"},
    {"memory_xx", plain, "xx component of the remembered tensor"},
    {"memory_xz", plain, "xz component of the remembered tensor"},
    {"memory_rho", plain, "remembered amount"},
    {"fluidity", rate, "strain rate over mu"},
    {"well_posedness_margin", plain, "of the symbol of the linearised equations; negative: ill-posed"},
    {"dv", speed, "fluctuation of the velocity"},
    {"domega", rate, "fluctuation of the spin"},
    {"coordination", plain, "loaded contacts per grain"},
    {"count", plain, "centres of grains in all snapshots"},
    {"fabric_xx", plain, "mean of n_x n_x over the contacts"},
    {"fabric_zz", plain, "mean of n_z n_z over the contacts"},
    {"fabric_xz", plain, "mean of n_x n_z over the contacts"},
    {"wall_x", stress_slope, "force of the walls on the grains per area, along x"},
    {"wall_z", stress_slope, "force of the walls on the grains per area, along z"},
    {"residual_x", plain, "missing in the balance of momentum along x, over the weight"},
    {"residual_z", plain, "missing in the balance of momentum along z, over the weight"},
    {"residual_x_without_kinetic", plain, "residual_x without the kinetic stress"},
    {"residual_z_without_kinetic", plain, "residual_z without the kinetic stress"},
    {"inertia_x", plain, "momentum along x carried away by the mean flow, over the weight"},
    {"inertia_z", plain, "momentum along z carried away by the mean flow, over the weight"},
    {"d_nu_dx", per_length, "slope of nu over x"},
    {"d_sigma_zz_dx", stress_slope, "slope of sigma_zz over x"},
    {"d_sigma_xx_dx", stress_slope, "slope of sigma_xx over x"},
    {"d_sigma_xz_dx", stress_slope, "slope of sigma_xz over x"},
    {"d_k_dx", per_length, "slope of k over x"},
    {"d_sigma_zz_dz", stress_slope, "slope of sigma_zz over z"},
    {"d_sigma_xx_dz", stress_slope, "slope of sigma_xx over z"},
    {"d_sigma_xz_dz", stress_slope, "slope of sigma_xz over z"},
    {"nu_voronoi", plain, "area of the grains over that of their Voronoi cells"},
    {"nu_grains", plain, "mean volume fraction of Voronoi cells"},
    {"zone", plain, "2: flowing, 1: static, 0: neither"},
    {"noise", plain, "1: log10_shear_rate is noise there"}};

/// Names that are made of another one, and what they say of it.
struct Part {
  std::string_view prefix, suffix;
  const char *before, *after;
};
constexpr Part parts[] = {{"log10_", "", "decimal logarithm of the ", ""},
                          {"displacement_", "", "", ", of displacements between snapshots"},
                          {"", "_particles", "", ", of the particles"},
                          {"", "_continuum", "", ", of the continuum"},
                          {"", "_kinetic", "part by velocity fluctuations of the ", ""},
                          {"", "_grains", "mean over the grains' contact stress, ", ""}};

}  // namespace

QuantityWords quantity_words(std::string_view name) {
  for (const Quantity& known : quantities)
    if (known.name == name) return {known.unit, known.meaning};
  for (const Part& part : parts) {
    if (!name.starts_with(part.prefix) || !name.ends_with(part.suffix)) continue;
    name.remove_prefix(part.prefix.size()), name.remove_suffix(part.suffix.size());
    QuantityWords words = quantity_words(name);
    if (!words.meaning.empty()) words.meaning = part.before + words.meaning + part.after;
    return words;
  }
  return {};
}

}  // namespace drumlin
