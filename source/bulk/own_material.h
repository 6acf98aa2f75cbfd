#ifndef nodus_bulk_own_material_h
#define nodus_bulk_own_material_h

#include "bulk/material.h"
#include <nodus/plugins/material_law.h>

namespace Nodus
{
  /// A law that a plug-in or a program brings.
  class OwnMaterial : public Material
  {
  public:
    /// @throws InputError where it has no stiffness
    explicit OwnMaterial(const Chosen<MaterialLaw> &law);

    unsigned int n_state() const override;
    void         set_initial(double *state) const override;
    void         correct_state(double *state) const override;
    void         set_step(double duration) override;
    void         evaluate(const dealii::Tensor<2, dim>    &F,
                          dealii::SymmetricTensor<2, dim> &S,
                          dealii::SymmetricTensor<4, dim> *C) const override;
    void         update(const dealii::Tensor<2, dim>    &F,
                        const double                    *before,
                        double                          *after,
                        dealii::SymmetricTensor<2, dim> &S,
                        dealii::SymmetricTensor<4, dim> *C) const override;
    void         update_lanes(const Lanes (&F)[dim][dim],
                              const Lanes *before,
                              Lanes       *after,
                              Lanes (&S)[n_pairs],
                              Lanes (*C)[n_pairs][n_pairs],
                              Lanes *energy) const override;
    double       energy(const dealii::Tensor<2, dim> &F) const override;
    double       stored_energy(const dealii::Tensor<2, dim> &F, const double *state) const override;
    double       dissipation(const double *state) const override;
    double       equivalent_plastic_strain(const double *state) const override;
    double       youngs_modulus() const override;

  protected:
    dealii::SymmetricTensor<2, dim> stress_again(const dealii::Tensor<2, dim> &F, const double *state) const override;

  private:
    std::shared_ptr<const MaterialLaw> law_;
    double                             duration_ = 0.; ///< of the step at hand
  };
} // namespace Nodus

#endif
