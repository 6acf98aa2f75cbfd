#include "mesh/region.h"
#include "mesh/sides.h"
#include "rigid/rigid_bodies.h"

#include <deal.II/base/numbers.h>

// The sections of bolts among all that is driven: the first of their six components is the shortening of the bolt.

namespace Nodus
{
  namespace
  {
    /// Cosine between the axis of a bolt and the mean normal of its section below which there is no section.
    constexpr double least_cosine = 0.1;
  } // namespace

  std::vector<unsigned int> RigidBodies::sections() const
  {
    std::vector<unsigned int> of_pairs(n_pairs_, dealii::numbers::invalid_unsigned_int);
    for (unsigned int i = 0; i < bodies_.size(); ++i)
      if (is_section(i))
        of_pairs[bodies_[i].pair] = i;
    return of_pairs;
  }

  std::vector<Vector3> RigidBodies::shortenings(const bool as_the_increment_began) const
  {
    const std::vector<State> &states = as_the_increment_began ? begin_ : now_;
    std::vector<Vector3>      shortenings;
    for (unsigned int i = 0; i < bodies_.size(); ++i)
      shortenings.push_back(states[i].translation[0] * bodies_[i].axis);
    return shortenings;
  }

  void
  RigidBodies::find_axis(Body &section, const dealii::DoFHandler<dim> &dof_handler, const dealii::Mapping<dim> &mapping)
  {
    if (section.axis != Vector3())
      return;
    const Region  region(section.section->slave, all_, section.label + ", slave");
    const Vector3 normal = mean_normal(region, dof_handler, mapping), given = section.section->preload.axis;
    const Vector3 axis = given == Vector3() ? normal : (given * normal < 0. ? -1. : 1.) * given;
    if (!(axis * normal > least_cosine * axis.norm()))
      throw InputError(section.label + ": " +
                       (given == Vector3()
                            ? "the slave faces look to all sides, so that a bolt has no axis there; choose the faces "
                              "of a cut through its shank, with 'Slave boundary ids' or 'Slave where'"
                            : "'Preload axis' lies in the slave faces, which are to be a cut through the bolt; give "
                              "the direction along the bolt"));
    section.axis = axis / axis.norm();
  }
} // namespace Nodus
