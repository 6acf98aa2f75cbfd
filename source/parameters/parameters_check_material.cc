#include "parameters/parameter_checks.h"
#include "parameters/plugin_keys.h"
#include <nodus/plugins/material_law.h>

#include <algorithm>
#include <functional>
#include <numeric>

// What the values of a material say together.

namespace Nodus
{
  namespace
  {
    using ParameterChecks::Given;
    using ParameterChecks::Section;

    void check_ogden(const Section &section, const MaterialParameters &material)
    {
      const auto &moduli = material.ogden_moduli, &exponents = material.ogden_exponents;
      section.require(!moduli.empty(), "Ogden moduli", "is missing; give one number for each term");
      section.require(exponents.size() == moduli.size(),
                      "Ogden exponents",
                      "has " + std::to_string(exponents.size()) + " entries for " + std::to_string(moduli.size()) +
                          " entries of Ogden moduli; give one for each term");
      section.require(std::count(exponents.begin(), exponents.end(), 0.) == 0,
                      "Ogden exponents",
                      "must not be 0; remove such a term");
      section.require(
          std::inner_product(moduli.begin(), moduli.end(), exponents.begin(), 0.) > 0.,
          "Ogden moduli",
          "times the exponents give a shear modulus that is not > 0; a modulus has the sign of its exponent");
    }

    void check_hardening(const Section &section, const MaterialParameters &material)
    {
      const auto &strains = material.hardening_strains, &stresses = material.hardening_stresses;
      if (!strains.empty() || !stresses.empty())
      {
        section.require(material.yield_stress == 0. && material.hardening_modulus == 0. &&
                            material.saturation_stress == 0. && material.saturation_rate == 0.,
                        "Hardening strains",
                        "is a table besides Yield stress, Hardening modulus or Saturation; remove one of the two");
        section.require(strains.size() == stresses.size(),
                        "Hardening stresses",
                        "has " + std::to_string(stresses.size()) + " entries for " + std::to_string(strains.size()) +
                            " entries of Hardening strains; give one for each");
        section.require(strains[0] == 0. &&
                            std::adjacent_find(strains.begin(), strains.end(), std::greater_equal<>()) == strains.end(),
                        "Hardening strains",
                        "must begin with 0 and increase");
        section.require(stresses[0] > 0. &&
                            std::adjacent_find(stresses.begin(), stresses.end(), std::greater<>()) == stresses.end(),
                        "Hardening stresses",
                        "must be > 0 and must not decrease; softening would depend on the mesh");
        return;
      }
      section.require(material.yield_stress > 0., "Yield stress", "must be given and > 0, or a hardening table");
      section.require((material.saturation_stress > 0.) == (material.saturation_rate > 0.),
                      "Saturation stress",
                      "and Saturation rate go together; give both or none");
      section.require(material.saturation_stress == 0. || material.saturation_stress >= material.yield_stress,
                      "Saturation stress",
                      "must not be below Yield stress; softening would depend on the mesh");
    }

    std::vector<Given> keys_of_plasticity(const MaterialParameters &material)
    {
      return {{"Yield stress", material.yield_stress != 0.},
              {"Hardening modulus", material.hardening_modulus != 0.},
              {"Saturation stress", material.saturation_stress != 0.},
              {"Saturation rate", material.saturation_rate != 0.},
              {"Hardening strains", !material.hardening_strains.empty()},
              {"Hardening stresses", !material.hardening_stresses.empty()}};
    }

    void check_poissons_ratio(const Section &section, const MaterialParameters &material)
    {
      section.require(
          material.poissons_ratio > -1. && material.poissons_ratio < 0.5,
          "Poisson's ratio",
          "must be > -1 and < 0.5; for nearly incompressible material take 0.499 and 'Volumetric treatment = "
          "mean dilatation'");
    }

    void check_youngs_modulus(const Section &section, const MaterialParameters &material)
    {
      section.require(material.youngs_modulus > 0., "Young's modulus", "must be given and > 0");
    }

    /// Its own keys are the matter of the law.
    void check_own(const Section &section, const MaterialParameters &material)
    {
      const bool elastic = material.own_law.object->uses_elastic_constants();
      for (const std::string &key : section.file.keys(section.name))
        section.require(key == "Law" || (elastic && (key == "Young's modulus" || key == "Poisson's ratio")),
                        key,
                        "has no effect on the law '" + material.own_law.name +
                            "', whose keys stand in a subsection of its name; remove it");
      if (!elastic)
        return;
      check_youngs_modulus(section, material);
      check_poissons_ratio(section, material);
    }
  } // namespace

  namespace ParameterChecks
  {
    void check(const Section &section, const MaterialParameters &material)
    {
      using Law = MaterialParameters::Law;
      if (material.law == Law::own)
        return check_own(section, material);
      check_poissons_ratio(section, material);
      section.require(material.mooney_rivlin_ratio == 0. || material.law == MaterialParameters::Law::mooney_rivlin,
                      "Mooney-Rivlin ratio",
                      "has no effect on this law; remove it or set Law = Mooney-Rivlin");
      if (material.law == Law::ogden)
      {
        section.require(material.youngs_modulus == 0.,
                        "Young's modulus",
                        "follows from the moduli and exponents of Ogden; remove it");
        check_ogden(section, material);
      }
      else
      {
        check_youngs_modulus(section, material);
        for (const auto &[key, values] :
             {std::pair<const char *, const std::vector<double> *>("Ogden moduli", &material.ogden_moduli),
              std::pair<const char *, const std::vector<double> *>("Ogden exponents", &material.ogden_exponents)})
          section.require(values->empty(), key, "has no effect on this law; remove it or set Law = Ogden");
      }
      if (material.law == Law::j2_plasticity)
        check_hardening(section, material);
      else
        for (const auto &[key, given] : keys_of_plasticity(material))
          section.require(!given, key, "has no effect on this law; remove it or set Law = J2 plasticity");
    }

    void refuse_material(const Section &section, const MaterialParameters &material)
    {
      const MaterialParameters none;
      std::vector<Given>       keys = keys_of_plasticity(material);
      keys.insert(keys.begin(),
                  {{"Young's modulus", material.youngs_modulus != 0.},
                   {"Poisson's ratio", material.poissons_ratio != none.poissons_ratio},
                   {"Law", material.law != none.law},
                   {"Mooney-Rivlin ratio", material.mooney_rivlin_ratio != 0.},
                   {"Ogden moduli", !material.ogden_moduli.empty()},
                   {"Ogden exponents", !material.ogden_exponents.empty()}});
      for (const auto &[key, given] : keys)
        section.require(!given, key, "has no meaning for a rigid body; remove the material, or 'Rigid = true'");
    }

    void initialize(const Section &section, const MaterialParameters &material)
    {
      if (material.law != MaterialParameters::Law::own)
        return;
      MaterialLaw &law = *material.own_law.object;
      if (law.uses_elastic_constants())
        law.set_elastic_constants(material.youngs_modulus, material.poissons_ratio);
      initialize(section, material.own_law.name, law);
      section.require(law.youngs_modulus() > 0.,
                      "Law",
                      "is '" + material.own_law.name + "', whose Young's modulus is " +
                          std::to_string(law.youngs_modulus()) + "; check the values of its keys, it must be > 0");
    }
  } // namespace ParameterChecks
} // namespace Nodus
