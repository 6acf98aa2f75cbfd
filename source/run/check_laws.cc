#include "bulk/check_material.h"
#include "contact/check_contact_laws.h"
#include "contact/surface.h"
#include "mesh/sides.h"
#include <nodus/run/check_laws.h>

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace Nodus
{
  namespace
  {
    /// A line for each comparison of a law. @returns whether all hold
    bool print(const std::string &law, const std::vector<LawCheck> &checks, std::ostream &log)
    {
      bool               hold = true;
      std::ostringstream text;
      text << law << '\n' << std::setprecision(2);
      for (const LawCheck &check : checks)
      {
        text << "  " << std::left << std::setw(52) << check.what << std::setw(8) << check.error
             << (check.holds() ? "" : " WRONG") << (check.where.empty() ? "no finite answer" : " at " + check.where)
             << '\n';
        hold = hold && check.holds() && !check.where.empty();
      }
      log << text.str();
      return hold;
    }

    std::string name_of(const MaterialParameters &material)
    {
      return material.law == MaterialParameters::Law::own ? material.own_law.name : text_of(material.law);
    }
  } // namespace

  bool check_laws(const Parameters &parameters, std::ostream &log)
  {
    bool   hold      = true;
    double stiffness = 0.; // of the softest body
    for (unsigned int b = 0; b < parameters.bodies.size(); ++b)
      if (const BodyParameters &body = parameters.bodies[b]; !body.rigid)
      {
        const auto   material = make_material(body.material);
        const double modulus  = material->youngs_modulus();
        stiffness             = stiffness > 0. ? std::min(stiffness, modulus) : modulus;
        hold = print("Body " + std::to_string(b + 1) + in_brackets(body.name) + ": " + name_of(body.material),
                     check_material(*material),
                     log) &&
               hold;
      }
    for (unsigned int p = 0; p < parameters.contact_pairs.size(); ++p)
    {
      const ContactPairParameters &pair = parameters.contact_pairs[p];
      const std::string            name = pair_label(parameters.contact_pairs, p) + ": ";
      if (pair.friction_law == ContactPairParameters::FrictionLaw::own)
        hold = print(name + pair.own_friction_law.name,
                     check_friction(*pair.own_friction_law.object, stiffness, 1.),
                     log) &&
               hold;
      if (const PressureGapParameters &gap = pair.pressure_gap; gap.law == PressureGapParameters::Law::own)
        hold = print(name + gap.own_law.name, check_pressure_gap(*gap.own_law.object, stiffness), log) && hold;
    }
    log << (hold ? "All laws hold: no relative error is above 1e-6\n"
                 : "A relative error above 1e-6 means that stress, tangent or energy of the law is wrong\n");
    return hold;
  }
} // namespace Nodus
