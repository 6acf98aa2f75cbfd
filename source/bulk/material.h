#ifndef nodus_bulk_material_h
#define nodus_bulk_material_h

#include "bulk/lanes.h"
#include <nodus/parameters/parameters.h>

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <memory>

namespace Nodus
{
  /// A law: second Piola-Kirchhoff stress and its material tangent at a deformation gradient. Laws with history have a
  /// state, n_state() numbers at each point, which goes from one equilibrium to the next.
  class Material
  {
  public:
    virtual ~Material() = default;

    /// True for laws of the linearised strain: F - I enters through its symmetric part only, no geometric
    /// stiffness, and the stress is at once S, P and Cauchy.
    virtual bool small_strain() const
    {
      return false;
    }

    /// True for RigidMaterial.
    virtual bool is_rigid() const
    {
      return false;
    }

    /// Numbers of the state at a point; 0: hyperelastic.
    virtual unsigned int n_state() const
    {
      return 0;
    }
    /// That of the material at rest; n_state() numbers.
    virtual void set_initial(double * /*state*/) const
    {
    }

    /// Makes a state that was interpolated between others one of the law.
    virtual void correct_state(double * /*state*/) const
    {
    }

    /// How long the steps of update() take from here on, in the time of the load path: for laws that depend on rates.
    virtual void set_step(double /*duration*/)
    {
    }

    /// Of a law with history: the response to F from rest.
    /// @param F deformation gradient, det F > 0 is the caller's duty
    /// @param S second Piola-Kirchhoff stress [pressure]
    /// @param C dS/dE, E Green-Lagrange strain [pressure]; not computed when null
    virtual void evaluate(const dealii::Tensor<2, dim>    &F,
                          dealii::SymmetricTensor<2, dim> &S,
                          dealii::SymmetricTensor<4, dim> *C) const = 0;

    /// evaluate() at a point of n_lanes cells at once; C null: not computed. The default asks evaluate() for each: a
    /// law overrides it to be fast.
    virtual void evaluate_lanes(const Lanes (&F)[dim][dim], Lanes (&S)[n_pairs], Lanes (*C)[n_pairs][n_pairs]) const;

    /// As evaluate(), in one step from the state @p before to the state @p after; C = dS/dE of that step.
    virtual void update(const dealii::Tensor<2, dim>    &F,
                        const double                    *before,
                        double                          *after,
                        dealii::SymmetricTensor<2, dim> &S,
                        dealii::SymmetricTensor<4, dim> *C) const;

    /// update() at a point of n_lanes cells at once, and stored_energy() at its end; not computed when null. Never both
    /// @p C and @p energy.
    virtual void update_lanes(const Lanes (&F)[dim][dim],
                              const Lanes *before,
                              Lanes       *after,
                              Lanes (&S)[n_pairs],
                              Lanes (*C)[n_pairs][n_pairs],
                              Lanes *energy) const;

    /// Stored energy per reference volume, zero at F = I; of a law with history: after the response to F from rest.
    virtual double energy(const dealii::Tensor<2, dim> &F) const = 0;

    /// Stored energy per reference volume at F and a state that F led to.
    virtual double stored_energy(const dealii::Tensor<2, dim> &F, const double * /*state*/) const
    {
      return energy(F);
    }
    /// Second Piola-Kirchhoff stress and stored_energy() at F and a state that F led to, at a point of n_lanes cells at
    /// once. The default asks for each: a law with history overrides it to be fast.
    virtual void
    stress_and_energy_lanes(const Lanes (&F)[dim][dim], const Lanes *state, Lanes (&S)[n_pairs], Lanes &energy) const;
    /// Work per reference volume that plastic flow took up to a state.
    virtual double dissipation(const double * /*state*/) const
    {
      return 0.;
    }
    virtual double equivalent_plastic_strain(const double * /*state*/) const
    {
      return 0.;
    }

    /// Initial Young's modulus, the stiffness scale of the contact augmentation.
    virtual double youngs_modulus() const = 0;

    /// Cauchy stress at F, of a law with history at a state that F led to; null: from rest.
    dealii::SymmetricTensor<2, dim> cauchy_stress(const dealii::Tensor<2, dim> &F, const double *state = nullptr) const;

  protected:
    /// Second Piola-Kirchhoff stress at F and a state that F led to: as update(), in a step that takes no time.
    virtual dealii::SymmetricTensor<2, dim> stress_again(const dealii::Tensor<2, dim> &F, const double *state) const;

    /// One cell of several that are worked on at once.
    static void take_lane(const Lanes (&F)[dim][dim], unsigned int lane, dealii::Tensor<2, dim> &F_cell);
    static void set_lane(const dealii::SymmetricTensor<2, dim> &S_cell,
                         const dealii::SymmetricTensor<4, dim> &C_cell,
                         unsigned int                           lane,
                         Lanes (&S)[n_pairs],
                         Lanes (*C)[n_pairs][n_pairs]);

    /// (A_ik A_jl + A_il A_jk)/2; for A = C^-1 it is -dC^-1/dC.
    static dealii::SymmetricTensor<4, dim> symmetric_square(const dealii::SymmetricTensor<2, dim> &A);
  };

  /// @throws InputError when E and nu are not those of a stable material.
  std::unique_ptr<Material> make_material(const MaterialParameters &parameters);
} // namespace Nodus

#endif
