#ifndef nodus_plugins_material_law_h
#define nodus_plugins_material_law_h

#include <nodus/base/types.h>
#include <nodus/plugins/plugin.h>

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

namespace Nodus
{
  /// A material of one's own, at finite strain: second Piola-Kirchhoff stress from the deformation gradient and, where
  /// it has a memory, from a state of n_state() numbers at each point. An energy alone is enough for HyperelasticLaw
  /// (hyperelastic_law.h). All functions that are const may be called for any point, in any order and number.
  class MaterialLaw : public Plugin
  {
  public:
    static constexpr const char *kind = "material law";

    /// From one equilibrium to the next.
    struct Step
    {
      const double *before;   ///< state at the last equilibrium; null without state
      double       *after;    ///< to be set to the state at the end of the step
      double        duration; ///< of the step, in the time t of the load path; 0: the same moment is looked at again
    };

    /// The response at the end of a step.
    /// @param F deformation gradient, det F > 0
    /// @param S second Piola-Kirchhoff stress [pressure]
    /// @param C dS/dE of the step, E the Green-Lagrange strain [pressure], with the symmetries of a second derivative
    /// of an energy; null: not asked for
    virtual void respond(const dealii::Tensor<2, dim>    &F,
                         const Step                      &step,
                         dealii::SymmetricTensor<2, dim> &S,
                         dealii::SymmetricTensor<4, dim> *C) const = 0;

    /// Energy per reference volume at F and a state that F led to, 0 at rest; @p state is null without state.
    virtual double stored_energy(const dealii::Tensor<2, dim> &F, const double *state) const = 0;

    /// Young's modulus of the undeformed material, > 0 [pressure]: the scale of stiffness that contact is weighted
    /// with.
    virtual double youngs_modulus() const = 0;

    virtual unsigned int n_state() const;
    /// That of the material at rest: zeros, unless it says otherwise.
    virtual void set_initial(double *state) const;
    /// Makes a state that was interpolated between others, for a refined mesh, one of the law.
    virtual void correct_state(double *state) const;

    /// Work per reference volume that is lost up to a state: for the balance of energies.
    virtual double dissipation(const double *state) const;
    /// For results and indicators of refinement.
    virtual double equivalent_plastic_strain(const double *state) const;

    /// Whether the keys "Young's modulus" and "Poisson's ratio" beside "Law" are for this law; otherwise they are
    /// refused.
    virtual bool uses_elastic_constants() const;
    /// Before initialize(), where they are: E > 0 [pressure], -1 < nu < 1/2.
    virtual void set_elastic_constants(double youngs_modulus, double poissons_ratio);
  };
} // namespace Nodus

/// NODUS_REGISTER_MATERIAL(Gent, "Gent", "Rubber whose chains have a limit.");
#define NODUS_REGISTER_MATERIAL(Class, name, meaning) NODUS_REGISTER(Nodus::MaterialLaw, Class, name, meaning)

#endif
