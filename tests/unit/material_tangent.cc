// Each law: S is the derivative of the energy, C that of S, both are objective, several points at once give what one
// after the other does, and the initial moduli are those of linear elasticity; closed-form stresses.

#include "bulk/material.h"

#include "../numbers.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>

using namespace dealii;
using Nodus::dim;
using Law = Nodus::MaterialParameters::Law;

namespace
{
  const double E = 3., nu = 0.3, lambda = E * nu / ((1. + nu) * (1. - 2. * nu)), mu = E / (2. * (1. + nu));

  std::unique_ptr<Nodus::Material> make(const Law law)
  {
    Nodus::MaterialParameters parameters;
    parameters.law                 = law;
    parameters.youngs_modulus      = E;
    parameters.poissons_ratio      = nu;
    parameters.mooney_rivlin_ratio = 0.4;
    if (law == Law::ogden)
    {
      // half the sum of the products is mu
      parameters.youngs_modulus  = 0.;
      parameters.ogden_exponents = {1.8, -2., 5.};
      const double sum           = 0.5 * 1.8 + 0.1 * 2. + 0.003 * 5.;
      parameters.ogden_moduli    = {0.5 * 2. * mu / sum, -0.1 * 2. * mu / sum, 0.003 * 2. * mu / sum};
    }
    if (law == Law::j2_plasticity)
    {
      parameters.yield_stress      = 0.3;
      parameters.hardening_modulus = 0.2;
      parameters.saturation_stress = 0.5;
      parameters.saturation_rate   = 4.;
    }
    return Nodus::make_material(parameters);
  }

  Tensor<2, dim> deformation(const unsigned int n)
  {
    // stretch, squeeze and shear, with rotation
    const double   values[3][9] = {{1.1, 0.2, -0.1, 0.05, 0.9, 0.3, 0., -0.2, 1.2},
                                   {0.6, 0., 0.1, 0., 1.5, 0., 0.2, 0., 0.8},
                                   {0.1, -1.2, 0.3, 1.3, 0.2, 0., 0.1, 0.3, 0.7}};
    Tensor<2, dim> F;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        F[i][j] = values[n][3 * i + j];
    return F;
  }

  Tensor<2, dim> unit(const unsigned int i, const unsigned int j)
  {
    Tensor<2, dim> result;
    result[i][j] = 1.;
    return result;
  }

  Tensor<2, dim> rotation()
  {
    const double   c = std::cos(0.7), s = std::sin(0.7);
    Tensor<2, dim> about_x, about_z;
    about_x[0][0] = about_z[2][2] = 1.;
    about_x[1][1] = about_x[2][2] = about_z[0][0] = about_z[1][1] = c;
    about_x[1][2] = about_z[0][1] = -s;
    about_x[2][1] = about_z[1][0] = s;
    return about_x * about_z;
  }

  void check(const std::string &what, const double error, const double tolerance)
  {
    std::cout << "  " << what << ' ' << tolerance << ": " << (error < tolerance ? "yes" : "NO") << std::endl;
    if (!(error < tolerance))
      std::cout << "    error " << error << std::endl;
  }

  /// Likewise of stress and energy at the states that F leads to from rest.
  double states_error(const Nodus::Material &material, const Nodus::Lanes (&F)[dim][dim])
  {
    using namespace Nodus;
    const unsigned int      n = material.n_state();
    std::vector<double>     rest(n), state(n);
    std::vector<Lanes>      states(n);
    Tensor<2, dim>          F_one[n_lanes];
    SymmetricTensor<2, dim> S_one, stress[n_lanes];
    double                  stored[n_lanes], error = 0.;
    material.set_initial(rest.data());
    for (unsigned int v = 0; v < n_lanes; ++v)
    {
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          F_one[v][i][j] = F[i][j][v];
      material.update(F_one[v], rest.data(), state.data(), S_one, nullptr);
      for (unsigned int i = 0; i < n; ++i)
        states[i][v] = state[i];
      stress[v] = material.cauchy_stress(F_one[v], state.data());
      stored[v] = material.stored_energy(F_one[v], state.data());
    }
    std::vector<Lanes> at_rest(n), after(n);
    for (unsigned int i = 0; i < n; ++i)
      at_rest[i] = Lanes{} + rest[i];
    Lanes S_after[n_pairs], energy_after;
    material.update_lanes(F, at_rest.data(), after.data(), S_after, nullptr, &energy_after);
    for (unsigned int v = 0; v < n_lanes; ++v)
      error = std::max(error, std::abs(energy_after[v] - stored[v]) / E);
    for (const bool by_default : {false, true})
    {
      Lanes S[n_pairs], energy;
      if (by_default)
        material.Material::stress_and_energy_lanes(F, states.data(), S, energy);
      else
        material.stress_and_energy_lanes(F, states.data(), S, energy);
      for (unsigned int v = 0; v < n_lanes; ++v)
      {
        for (unsigned int r = 0; r < n_pairs; ++r)
          S_one.access_raw_entry(r) = S[r][v];
        if (!material.small_strain())
          S_one = symmetrize(F_one[v] * Tensor<2, dim>(S_one) * transpose(F_one[v])) / determinant(F_one[v]);
        error = std::max({error, (S_one - stress[v]).norm() / E, std::abs(energy[v] - stored[v]) / E});
      }
    }
    return error;
  }

  /// Largest difference of several points at once from one after the other, relative; also of the default that asks
  /// evaluate().
  double lanes_error(const Nodus::Material &material)
  {
    using namespace Nodus;
    double error = 0.;
    Lanes  F[dim][dim], S[n_pairs], C[n_pairs][n_pairs];
    for (unsigned int v = 0; v < n_lanes; ++v)
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          F[i][j][v] = v < 3 ? deformation(v)[i][j] : i == j;
    for (const bool by_default : {false, true})
    {
      if (by_default)
        material.Material::evaluate_lanes(F, S, &C);
      else
        material.evaluate_lanes(F, S, &C);
      for (unsigned int v = 0; v < n_lanes; ++v)
      {
        SymmetricTensor<2, dim> S_one;
        SymmetricTensor<4, dim> C_one;
        material.evaluate(v < 3 ? deformation(v) : Tensor<2, dim>(unit_symmetric_tensor<dim>()), S_one, &C_one);
        for (unsigned int r = 0; r < n_pairs; ++r)
        {
          error = std::max(error, std::abs(S[r][v] - S_one.access_raw_entry(r)) / C_one.norm());
          for (unsigned int c = 0; c < n_pairs; ++c)
            error = std::max(error, std::abs(C[r][c][v] - C_one.access_raw_entry(n_pairs * r + c)) / C_one.norm());
        }
      }
    }
    return std::max(error, states_error(material, F));
  }

  /// What the stress is the derivative of: the stored energy and, for a step with plastic flow from rest, the work of
  /// that flow (Ortiz & Stainier, Comput. Methods Appl. Mech. Eng. 171, 1999).
  double potential(const Nodus::Material &material, const Tensor<2, dim> &F)
  {
    SymmetricTensor<2, dim> S;
    std::vector<double>     rest(material.n_state()), state(rest);
    material.set_initial(rest.data());
    material.update(F, rest.data(), state.data(), S, nullptr);
    return material.stored_energy(F, state.data()) + material.dissipation(state.data());
  }

  void run(const std::string &name, const Law law)
  {
    const auto   material = make(law);
    const bool   small    = material->small_strain();
    const double h        = 1e-5;
    std::cout << name << std::endl;

    double stress_error = 0., tangent_error = 0., symmetry_error = 0., rotation_error = 0.;
    double stress_size = 0., tangent_size = 0.;
    for (unsigned int n = 0; n < 3; ++n)
    {
      const auto              F = deformation(n);
      SymmetricTensor<2, dim> S, S_plus, S_minus;
      SymmetricTensor<4, dim> C;
      material->evaluate(F, S, &C);
      const Tensor<2, dim> P = small ? Tensor<2, dim>(S) : F * Tensor<2, dim>(S);
      stress_size += P.norm();
      tangent_size += C.norm();
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
        {
          const auto   dF = unit(i, j);
          const double dW = (potential(*material, F + h * dF) - potential(*material, F - h * dF)) / (2. * h);
          stress_error    = std::max(stress_error, std::abs(dW - P[i][j]));

          material->evaluate(F + h * dF, S_plus, nullptr);
          material->evaluate(F - h * dF, S_minus, nullptr);
          const auto strain = symmetrize(small ? dF : transpose(F) * dF);
          const auto dS     = C * strain;
          tangent_error     = std::max(tangent_error, ((S_plus - S_minus) / (2. * h) - dS).norm() / C.norm());
        }
      for (unsigned int r = 0; r < 6; ++r)
        for (unsigned int c = 0; c < 6; ++c)
          symmetry_error =
              std::max(symmetry_error, std::abs(C.access_raw_entry(6 * r + c) - C.access_raw_entry(6 * c + r)));
      if (!small)
      {
        material->evaluate(rotation() * F, S_plus, nullptr);
        rotation_error = std::max(rotation_error, (S_plus - S).norm() / S.norm());
      }
    }
    check("stress = dW/dF, sum of norms " + Numbers::number(stress_size) + ", within", stress_error, 1e-8);
    check("tangent = dS/dE, sum of norms " + Numbers::number(tangent_size) + ", within", tangent_error, 1e-8);
    check("tangent symmetric within", symmetry_error, 1e-13);
    if (!small)
      check("stress unchanged by rotation within", rotation_error, 1e-13);

    SymmetricTensor<2, dim> S;
    SymmetricTensor<4, dim> C;
    const auto              I = unit_symmetric_tensor<dim>();
    material->evaluate(I, S, &C);
    const auto hooke = lambda * outer_product(I, I) + 2. * mu * identity_tensor<dim>();
    check("stress and energy at rest within", S.norm() + std::abs(material->energy(I)), 1e-13);
    check("initial tangent Hooke's within", (C - hooke).norm() / hooke.norm(), 1e-13);
    check("several points at once within", lanes_error(*material), 1e-13);
    check("initial modulus E within", std::abs(material->youngs_modulus() - E), 1e-13);
  }

  void closed_forms()
  {
    // uniform stretch s and simple shear gamma, Cauchy stress
    const double   s = 0.8, J = s * s * s, gamma = 0.5;
    Tensor<2, dim> stretch, shear;
    for (unsigned int i = 0; i < dim; ++i)
    {
      stretch[i][i] = s;
      shear[i][i]   = 1.;
    }
    shear[0][1] = gamma;

    std::cout << "Cauchy stress, stretch 0.8: computed, expected" << std::endl;
    const double green = (s * s - 1.) / 2.;
    std::cout << "  linear elastic       " << make(Law::linear_elastic)->cauchy_stress(stretch)[1][1] << ' '
              << (3. * lambda + 2. * mu) * (s - 1.) << std::endl;
    std::cout << "  St Venant-Kirchhoff  " << make(Law::st_venant_kirchhoff)->cauchy_stress(stretch)[1][1] << ' '
              << (3. * lambda + 2. * mu) * green / s << std::endl;
    std::cout << "  neo-Hookean          " << make(Law::neo_hookean)->cauchy_stress(stretch)[1][1] << ' '
              << (mu * (s * s - 1.) + lambda * std::log(J)) / J << std::endl;
    std::cout << "  Mooney-Rivlin        " << make(Law::mooney_rivlin)->cauchy_stress(stretch)[1][1] << ' '
              << (lambda + 2. / 3. * mu) * (J - 1.) << std::endl;
    std::cout << "Cauchy shear stress, simple shear 0.5: computed, expected" << std::endl;
    std::cout << "  neo-Hookean          " << make(Law::neo_hookean)->cauchy_stress(shear)[0][1] << ' ' << mu * gamma
              << std::endl;
    std::cout << "  Mooney-Rivlin        " << make(Law::mooney_rivlin)->cauchy_stress(shear)[0][1] << ' ' << mu * gamma
              << std::endl;
    // N1 = sigma_xx - sigma_yy = mu gamma^2, N2 = sigma_yy - sigma_zz = -2 c01 gamma^2
    const auto sigma = make(Law::mooney_rivlin)->cauchy_stress(shear);
    std::cout << "Normal stress differences of Mooney-Rivlin: computed, expected" << std::endl;
    std::cout << "  N1 " << sigma[0][0] - sigma[1][1] << ' ' << mu * gamma * gamma << std::endl;
    std::cout << "  N2 " << sigma[1][1] - sigma[2][2] << ' ' << -mu * 0.4 / 1.4 * gamma * gamma << std::endl;
  }
} // namespace

int main()
{
  run("linear elastic", Law::linear_elastic);
  run("St Venant-Kirchhoff", Law::st_venant_kirchhoff);
  run("neo-Hookean", Law::neo_hookean);
  run("Mooney-Rivlin", Law::mooney_rivlin);
  run("Ogden", Law::ogden);
  run("J2 plasticity", Law::j2_plasticity);
  std::cout << std::setprecision(5);
  closed_forms();
  try
  {
    Nodus::MaterialParameters incompressible;
    incompressible.youngs_modulus = 1.;
    incompressible.poissons_ratio = 0.5;
    Nodus::make_material(incompressible);
    std::cout << "nu = 0.5 accepted: NO" << std::endl;
  }
  catch (const Nodus::InputError &error)
  {
    std::cout << error.what() << std::endl;
  }
}
