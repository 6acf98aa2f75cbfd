#include "bulk/material.h"
#include "bulk/j2_plasticity.h"
#include "bulk/linear_elastic.h"
#include "bulk/mooney_rivlin.h"
#include "bulk/neo_hookean.h"
#include "bulk/ogden.h"
#include "bulk/own_material.h"
#include "bulk/st_venant_kirchhoff.h"

namespace Nodus
{
  using namespace dealii;

  SymmetricTensor<2, dim> Material::cauchy_stress(const Tensor<2, dim> &F, const double *const state) const
  {
    SymmetricTensor<2, dim> S;
    if (state)
      S = stress_again(F, state);
    else
      evaluate(F, S, nullptr);
    if (small_strain())
      return S;
    return symmetrize(F * Tensor<2, dim>(S) * transpose(F)) / determinant(F);
  }

  SymmetricTensor<2, dim> Material::stress_again(const Tensor<2, dim> &F, const double *const state) const
  {
    SymmetricTensor<2, dim> S;
    std::vector<double>     unchanged(n_state());
    update(F, state, unchanged.data(), S, nullptr);
    return S;
  }

  void Material::update(
      const Tensor<2, dim> &F, const double *, double *, SymmetricTensor<2, dim> &S, SymmetricTensor<4, dim> *C) const
  {
    evaluate(F, S, C);
  }

  void Material::update_lanes(const Lanes (&F)[dim][dim],
                              const Lanes *const before,
                              Lanes *,
                              Lanes (&S)[n_pairs],
                              Lanes (*const C)[n_pairs][n_pairs],
                              Lanes *const energy) const
  {
    if (energy)
      stress_and_energy_lanes(F, before, S, *energy);
    else
      evaluate_lanes(F, S, C);
  }

  void Material::evaluate_lanes(const Lanes (&F)[dim][dim], Lanes (&S)[n_pairs], Lanes (*C)[n_pairs][n_pairs]) const
  {
    Tensor<2, dim>          F_cell;
    SymmetricTensor<2, dim> S_cell;
    SymmetricTensor<4, dim> C_cell;
    for (unsigned int v = 0; v < n_lanes; ++v)
    {
      take_lane(F, v, F_cell);
      evaluate(F_cell, S_cell, C ? &C_cell : nullptr);
      set_lane(S_cell, C_cell, v, S, C);
    }
  }

  void Material::stress_and_energy_lanes(const Lanes (&F)[dim][dim],
                                         const Lanes *const state,
                                         Lanes (&S)[n_pairs],
                                         Lanes &energy) const
  {
    const unsigned int n = n_state();
    if (n == 0)
      evaluate_lanes(F, S, nullptr);
    std::vector<double> state_of_cell(n);
    Tensor<2, dim>      F_cell;
    for (unsigned int v = 0; v < n_lanes; ++v)
    {
      take_lane(F, v, F_cell);
      for (unsigned int i = 0; i < n; ++i)
        state_of_cell[i] = state[i][v];
      if (n > 0)
        set_lane(stress_again(F_cell, state_of_cell.data()), {}, v, S, nullptr);
      energy[v] = stored_energy(F_cell, state_of_cell.data());
    }
  }

  void Material::take_lane(const Lanes (&F)[dim][dim], const unsigned int lane, Tensor<2, dim> &F_cell)
  {
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int J = 0; J < dim; ++J)
        F_cell[i][J] = F[i][J][lane];
  }

  void Material::set_lane(const SymmetricTensor<2, dim> &S_cell,
                          const SymmetricTensor<4, dim> &C_cell,
                          const unsigned int             lane,
                          Lanes (&S)[n_pairs],
                          Lanes (*C)[n_pairs][n_pairs])
  {
    for (unsigned int r = 0; r < n_pairs; ++r)
    {
      S[r][lane] = S_cell.access_raw_entry(r);
      for (unsigned int c = 0; C && c < n_pairs; ++c)
        (*C)[r][c][lane] = C_cell.access_raw_entry(n_pairs * r + c);
    }
  }

  SymmetricTensor<4, dim> Material::symmetric_square(const SymmetricTensor<2, dim> &A)
  {
    // rows and columns of the 6x6 storage
    constexpr unsigned int  n        = SymmetricTensor<2, dim>::n_independent_components;
    constexpr unsigned int  first[n] = {0, 1, 2, 0, 0, 1}, second[n] = {0, 1, 2, 1, 2, 2};
    const Tensor<2, dim>    a = A;
    SymmetricTensor<4, dim> result;
    for (unsigned int r = 0; r < n; ++r)
      for (unsigned int c = 0; c < n; ++c)
      {
        const unsigned int i = first[r], j = second[r], k = first[c], l = second[c];
        result.access_raw_entry(n * r + c) = 0.5 * (a[i][k] * a[j][l] + a[i][l] * a[j][k]);
      }
    return result;
  }

  std::unique_ptr<Material> make_material(const MaterialParameters &parameters)
  {
    if (parameters.law == MaterialParameters::Law::own)
      return std::make_unique<OwnMaterial>(parameters.own_law);
    const double E = parameters.youngs_modulus, nu = parameters.poissons_ratio;
    const bool   ogden = parameters.law == MaterialParameters::Law::ogden; // E follows from the moduli
    if (!(E > 0. || ogden) || !(nu > -1. && nu < 0.5) || !(parameters.mooney_rivlin_ratio >= 0.))
      throw InputError("Material: Young's modulus " + std::to_string(E) + ", Poisson's ratio " + std::to_string(nu) +
                       ", Mooney-Rivlin ratio " + std::to_string(parameters.mooney_rivlin_ratio) +
                       "; needed are E > 0, -1 < nu < 0.5 and a ratio >= 0");
    switch (parameters.law)
    {
      case MaterialParameters::Law::linear_elastic:
        return std::make_unique<LinearElastic>(parameters);
      case MaterialParameters::Law::st_venant_kirchhoff:
        return std::make_unique<StVenantKirchhoff>(parameters);
      case MaterialParameters::Law::neo_hookean:
        return std::make_unique<NeoHookean>(parameters);
      case MaterialParameters::Law::mooney_rivlin:
        return std::make_unique<MooneyRivlin>(parameters);
      case MaterialParameters::Law::ogden:
        return std::make_unique<Ogden>(parameters);
      case MaterialParameters::Law::j2_plasticity:
        return std::make_unique<J2Plasticity>(parameters);
      case MaterialParameters::Law::own:
        break;
    }
    throw InputError("Material: unknown law");
  }
} // namespace Nodus
