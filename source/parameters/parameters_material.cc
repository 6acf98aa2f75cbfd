#include "parameters/parameter_keys.h"
#include "parameters/plugin_keys.h"
#include <nodus/parameters/parameters.h>
#include <nodus/plugins/material_law.h>

// Keys of materials.

namespace Nodus
{
  namespace
  {
    using namespace ParameterKeys;

    const Names<MaterialParameters::Law> law_names = {
        {MaterialParameters::Law::linear_elastic, "linear elastic"},
        {MaterialParameters::Law::st_venant_kirchhoff, "St Venant-Kirchhoff"},
        {MaterialParameters::Law::neo_hookean, "neo-Hookean"},
        {MaterialParameters::Law::mooney_rivlin, "Mooney-Rivlin"},
        {MaterialParameters::Law::ogden, "Ogden"},
        {MaterialParameters::Law::j2_plasticity, "J2 plasticity"}};

  } // namespace

  namespace ParameterKeys
  {
    void add_material(ParameterHandler &prm, MaterialParameters &material)
    {
      add_choice(
          prm,
          "Law",
          material.law,
          law_names,
          MaterialParameters::Law::own,
          material.own_law,
          "Law of the material [-]. All but the first are finite-strain laws; J2 plasticity is elastoplastic with "
          "isotropic hardening, in logarithmic strains and Kirchhoff stresses.");
      prm.add_parameter(
          "Young's modulus",
          material.youngs_modulus,
          "Young's modulus of the undeformed material [pressure], > 0. Must be given, but for Ogden, where "
          "it is (1 + nu) times the sum of the products of moduli and exponents.",
          not_negative);
      prm.add_parameter("Poisson's ratio",
                        material.poissons_ratio,
                        "Poisson's ratio of the undeformed material [-], > -1 and < 0.5. From 0.45 on low-order cells "
                        "lock: see Volumetric treatment.",
                        any_number);
      prm.add_parameter("Mooney-Rivlin ratio",
                        material.mooney_rivlin_ratio,
                        "Ratio of the second to the first constant of the Mooney-Rivlin law [-]; 0 is neo-Hookean.",
                        not_negative);
      prm.add_parameter("Ogden moduli",
                        material.ogden_moduli,
                        "Moduli mu_i of the terms mu_i/alpha_i (sum of isochoric stretches^alpha_i - 3) of Ogden's law "
                        "[pressure]. Half the sum of mu_i alpha_i is the initial shear modulus.",
                        numbers);
      prm.add_parameter("Ogden exponents",
                        material.ogden_exponents,
                        "Exponents alpha_i of Ogden's law [-], one for each modulus, not 0.",
                        numbers);
      prm.add_parameter("Yield stress",
                        material.yield_stress,
                        "J2 plasticity: initial yield stress [pressure], > 0. Must be given, or the hardening table.",
                        not_negative);
      prm.add_parameter("Hardening modulus",
                        material.hardening_modulus,
                        "J2 plasticity: linear hardening, yield stress over equivalent plastic strain [pressure].",
                        not_negative);
      prm.add_parameter(
          "Saturation stress",
          material.saturation_stress,
          "J2 plasticity: yield stress that Voce's exponential hardening tends to, without the linear part "
          "[pressure]; 0: no such hardening.",
          not_negative);
      prm.add_parameter("Saturation rate",
                        material.saturation_rate,
                        "J2 plasticity: factor of the equivalent plastic strain in the exponential [-].",
                        not_negative);
      prm.add_parameter("Hardening strains",
                        material.hardening_strains,
                        "J2 plasticity: equivalent plastic strains of a hardening table [-], the first 0, increasing; "
                        "the yield stress is linear in between and constant behind the last. Instead of the four keys "
                        "above.",
                        numbers);
      prm.add_parameter("Hardening stresses",
                        material.hardening_stresses,
                        "J2 plasticity: yield stresses of the hardening table [pressure], > 0, not decreasing.",
                        numbers);
    }
  } // namespace ParameterKeys

  std::string text_of(const MaterialParameters::Law law)
  {
    return text_of(law, law_names);
  }
} // namespace Nodus
