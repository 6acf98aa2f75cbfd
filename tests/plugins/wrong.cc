// Plug-ins with one mistake each, the last one without: MISTAKE says which.

#include <nodus/plugins/material_law.h>

#include <deal.II/base/parameter_handler.h>

namespace
{
  class Law : public Nodus::MaterialLaw
  {
  public:
    void respond(const dealii::Tensor<2, Nodus::dim> &,
                 const Step &,
                 dealii::SymmetricTensor<2, Nodus::dim> &,
                 dealii::SymmetricTensor<4, Nodus::dim> *) const override
    {
    }
    double stored_energy(const dealii::Tensor<2, Nodus::dim> &, const double *) const override
    {
      return 0.;
    }
    double youngs_modulus() const override
    {
      return 1.;
    }
#if MISTAKE == 5
    void add_parameters(dealii::ParameterHandler &prm) override
    {
      prm.enter_subsection("left open");
    }
#elif MISTAKE == 8
    void add_parameters(dealii::ParameterHandler &prm) override
    {
      prm.add_parameter("Modulus", modulus_, "A key that only cases with this law have [pressure].");
    }
    double modulus_ = 1.;
#endif
  };
} // namespace

#if MISTAKE == 0 // registers nothing
extern const Law law;
const Law        law;
#elif MISTAKE == 1
NODUS_REGISTER_MATERIAL(Law, "twice", "One.");
NODUS_REGISTER_MATERIAL(Law, "twice", "The other.");
#elif MISTAKE == 2
NODUS_REGISTER_MATERIAL(Law, "neo-Hookean", "As nodus's.");
#elif MISTAKE == 3
static const Nodus::Plugins::Registration other_version("nodus 0.0.1, deal.II 9.0.0, Release",
                                                        Nodus::MaterialLaw::kind,
                                                        "other version",
                                                        "Of another nodus.",
                                                        &Nodus::Plugins::make<Nodus::MaterialLaw, Law>);
#elif MISTAKE == 4
NODUS_REGISTER_MATERIAL(Law, "a/b", "A path.");
#elif MISTAKE == 5
NODUS_REGISTER_MATERIAL(Law, "unbalanced", "Leaves a subsection open.");
#elif MISTAKE == 6
void undefined();
extern void (*const calls)();
void (*const calls)() = &undefined;
NODUS_REGISTER_MATERIAL(Law, "undefined", "Calls what nobody has.");
#elif MISTAKE == 7
NODUS_REGISTER_MATERIAL(Law, "Kirchhoff with moduli", "As that of another plug-in.");
#elif MISTAKE == 8
NODUS_REGISTER_MATERIAL(Law, "another", "A right one.");
#endif
