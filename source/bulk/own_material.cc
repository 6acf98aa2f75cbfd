#include "bulk/own_material.h"

#include <algorithm>
#include <vector>

namespace Nodus
{
  using namespace dealii;

  unsigned int MaterialLaw::n_state() const
  {
    return 0;
  }

  void MaterialLaw::set_initial(double *const state) const
  {
    std::fill_n(state, n_state(), 0.);
  }

  void MaterialLaw::correct_state(double * /*state*/) const
  {
  }

  double MaterialLaw::dissipation(const double * /*state*/) const
  {
    return 0.;
  }

  double MaterialLaw::equivalent_plastic_strain(const double * /*state*/) const
  {
    return 0.;
  }

  bool MaterialLaw::uses_elastic_constants() const
  {
    return false;
  }

  void MaterialLaw::set_elastic_constants(const double /*youngs_modulus*/, const double /*poissons_ratio*/)
  {
  }

  OwnMaterial::OwnMaterial(const Chosen<MaterialLaw> &law)
      : law_(law.object)
  {
    if (!law_)
      throw InputError("Material: the law is one's own, but there is none; set MaterialParameters::own_law");
    if (!(law_->youngs_modulus() > 0.))
      throw InputError("Material: Young's modulus of the law '" + law.name + "' is " +
                       std::to_string(law_->youngs_modulus()) + "; it must be > 0");
  }

  unsigned int OwnMaterial::n_state() const
  {
    return law_->n_state();
  }

  void OwnMaterial::set_initial(double *const state) const
  {
    law_->set_initial(state);
  }

  void OwnMaterial::correct_state(double *const state) const
  {
    law_->correct_state(state);
  }

  void OwnMaterial::set_step(const double duration)
  {
    duration_ = duration;
  }

  void OwnMaterial::update(const Tensor<2, dim>    &F,
                           const double            *before,
                           double                  *after,
                           SymmetricTensor<2, dim> &S,
                           SymmetricTensor<4, dim> *C) const
  {
    law_->respond(F, {before, after, duration_}, S, C);
  }

  void OwnMaterial::evaluate(const Tensor<2, dim> &F, SymmetricTensor<2, dim> &S, SymmetricTensor<4, dim> *C) const
  {
    std::vector<double> rest(n_state()), after(n_state());
    law_->set_initial(rest.data());
    law_->respond(F, {rest.data(), after.data(), 0.}, S, C);
  }

  SymmetricTensor<2, dim> OwnMaterial::stress_again(const Tensor<2, dim> &F, const double *const state) const
  {
    SymmetricTensor<2, dim> S;
    std::vector<double>     unchanged(n_state());
    law_->respond(F, {state, unchanged.data(), 0.}, S, nullptr);
    return S;
  }

  void OwnMaterial::update_lanes(const Lanes (&F)[dim][dim],
                                 const Lanes *const before,
                                 Lanes *const       after,
                                 Lanes (&S)[n_pairs],
                                 Lanes (*C)[n_pairs][n_pairs],
                                 Lanes *const energy) const
  {
    const unsigned int      n = n_state();
    std::vector<double>     state_before(n), state_after(n);
    Tensor<2, dim>          F_cell;
    SymmetricTensor<2, dim> S_cell;
    SymmetricTensor<4, dim> C_cell;
    for (unsigned int v = 0; v < n_lanes; ++v)
    {
      for (unsigned int i = 0; i < n; ++i)
        state_before[i] = before[i][v];
      take_lane(F, v, F_cell);
      update(F_cell, state_before.data(), state_after.data(), S_cell, C ? &C_cell : nullptr);
      set_lane(S_cell, C_cell, v, S, C);
      for (unsigned int i = 0; i < n; ++i)
        after[i][v] = state_after[i];
      if (energy)
        (*energy)[v] = law_->stored_energy(F_cell, state_after.data());
    }
  }

  double OwnMaterial::energy(const Tensor<2, dim> &F) const
  {
    std::vector<double> rest(n_state()), state(n_state());
    law_->set_initial(rest.data());
    SymmetricTensor<2, dim> S;
    if (!state.empty())
      law_->respond(F, {rest.data(), state.data(), 0.}, S, nullptr);
    return law_->stored_energy(F, state.data());
  }

  double OwnMaterial::stored_energy(const Tensor<2, dim> &F, const double *const state) const
  {
    return law_->stored_energy(F, state);
  }

  double OwnMaterial::dissipation(const double *const state) const
  {
    return law_->dissipation(state);
  }

  double OwnMaterial::equivalent_plastic_strain(const double *const state) const
  {
    return law_->equivalent_plastic_strain(state);
  }

  double OwnMaterial::youngs_modulus() const
  {
    return law_->youngs_modulus();
  }
} // namespace Nodus
