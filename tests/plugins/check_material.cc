// What `nodus --check-law` compares: shipped laws and a right law of one's own hold, each mistake that is put into one
// shows where it belongs, and only there.

#include "bulk/check_material.h"
#include "../cases.h"
#include "bulk/own_material.h"
#include "maxwell.h"

#include <deal.II/base/mpi.h>

using namespace Cases;

namespace
{
  enum class Mistake
  {
    none,
    tangent,
    energy,
    not_objective,
    prestress,
    domain
  };

  class Wrong : public Maxwell
  {
  public:
    explicit Wrong(const Mistake mistake)
        : mistake_(mistake)
    {
      share_ = 0.5;
      tau_   = 0.7;
      set_elastic_constants(10., 0.3);
    }
    void respond(const dealii::Tensor<2, dim>          &F,
                 const Step                            &step,
                 dealii::SymmetricTensor<2, dim>       &S,
                 dealii::SymmetricTensor<4, dim> *const C) const override
    {
      Maxwell::respond(F, step, S, C);
      if (mistake_ == Mistake::tangent && C)
        (*C)[0][1][0][1] *= 1.00001;
      if (mistake_ == Mistake::not_objective)
        S[0][0] += 1e-5 * (F[1][0] - F[0][1]);
      if (mistake_ == Mistake::prestress)
        S[2][2] += 1e-3;
      if (mistake_ == Mistake::domain && trace(symmetrize(transpose(F) * F)) > 3.5)
        S[0][0] = std::nan("");
    }
    double stored_energy(const dealii::Tensor<2, dim> &F, const double *state) const override
    {
      if (mistake_ == Mistake::domain && trace(symmetrize(transpose(F) * F)) > 3.5)
        return std::nan("");
      return (mistake_ == Mistake::energy ? 1.0001 : 1.) * Maxwell::stored_energy(F, state);
    }

  private:
    Mistake mistake_;
  };

  /// What does not hold.
  std::string wrong(Material &material)
  {
    std::string text;
    for (const LawCheck &check : check_material(material))
      if (!check.holds())
        text += (text.empty() ? "" : ", ") + check.what;
    return text.empty() ? "nothing" : text;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  using Law = MaterialParameters::Law;
  for (const Law law : {Law::linear_elastic,
                        Law::st_venant_kirchhoff,
                        Law::neo_hookean,
                        Law::mooney_rivlin,
                        Law::ogden,
                        Law::j2_plasticity})
  {
    MaterialParameters p;
    p.law                 = law;
    p.youngs_modulus      = law == Law::ogden ? 0. : 3.;
    p.mooney_rivlin_ratio = law == Law::mooney_rivlin ? 0.3 : 0.;
    p.ogden_moduli        = {1., -0.2};
    p.ogden_exponents     = {1.8, -2.};
    p.yield_stress        = 0.3;
    p.hardening_modulus   = 0.2;
    report(text_of(law) + ", wrong", wrong(*make_material(p)));
  }
  const std::pair<Mistake, const char *> mistakes[] = {{Mistake::none, "no mistake"},
                                                       {Mistake::tangent, "a modulus of the tangent"},
                                                       {Mistake::energy, "the size of the energy"},
                                                       {Mistake::not_objective, "a stress that sees rotations"},
                                                       {Mistake::prestress, "a stress at rest"},
                                                       {Mistake::domain, "no answer at large strains"}};
  for (const auto &[mistake, name] : mistakes)
  {
    OwnMaterial material({std::make_shared<Wrong>(mistake), "wrong"});
    report(std::string(name) + ", wrong", wrong(material));
  }
}
