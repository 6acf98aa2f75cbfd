#include "run/driven_rigid_bodies.h"

// Faces of deformable bodies whose nodes move as those of a rigid body: what of the tangent is theirs makes the border.

namespace Nodus
{
  namespace
  {
    constexpr unsigned int n_components = RigidBodies::n_components;
  }

  /// Six motions of each face (eq. R10), columns over the owned displacements. @p coupled is 1 at those that follow
  /// faces.
  std::vector<std::vector<double>> DrivenRigidBodies::face_motions(const LinearSystem  &system,
                                                                   std::vector<double> &coupled) const
  {
    const RigidBodies               &rigid_bodies = model_.rigid_bodies;
    const BlockLayout               &layout       = *system.layout;
    std::vector<std::vector<double>> motions(n_components * rigid_bodies.size());
    coupled.assign(layout.owned[0].n_elements(), 0.);
    for (unsigned int b = 0; b < rigid_bodies.size(); ++b)
    {
      if (!rigid_bodies.is_face(b))
        continue;
      for (unsigned int c = 0; c < n_components; ++c)
        motions[n_components * b + c].assign(coupled.size(), 0.);
      for (const RigidBodies::Node &node : rigid_bodies.nodes(b))
        for (unsigned int c = 0; c < dim; ++c)
        {
          if (!rigid_bodies.moves(b, c))
            continue;
          const auto i = layout.owned[0].index_within_set(node.dof + c);
          coupled[i]   = 1.;
          model_.contact->surfaces().for_each_rigid_unknown(b,
                                                            c,
                                                            1.,
                                                            rigid_bodies.arm(b, node),
                                                            [&](const DoFIndex column, const double part)
                                                            { motions[column - layout.size()][i] += part; });
        }
    }
    return motions;
  }

  void DrivenRigidBodies::take_faces(LinearSystem &system)
  {
    face_border_.clear();
    face_rhs_.assign(n_components * model_.rigid_bodies.size(), 0.);
    if (!model_.rigid_bodies.has_faces())
      return;
    const BlockLayout                     &layout = *system.layout;
    std::vector<double>                    coupled;
    const std::vector<std::vector<double>> motions = face_motions(system, coupled);
    Vector                                &rhs     = system.rhs.block(0);
    std::vector<double>                    force(coupled.size());
    for (unsigned int m = 0; m < motions.size(); ++m)
    {
      if (motions[m].empty())
        continue;
      system.bulk.vmult(force.data(), motions[m].data());
      for (unsigned int i = 0; i < force.size(); ++i)
      {
        if (coupled[i] != 0.)
          face_rhs_[m] += motions[m][i] * rhs.local_element(i);
        if (force[i] == 0.)
          continue;
        if (coupled[i] == 0.)
        {
          const DoFIndex dof = layout.owned[0].nth_index_in_set(i);
          face_border_.add(dof, layout.size() + m, force[i]);
          face_border_.add(layout.size() + m, dof, force[i]);
          continue;
        }
        for (unsigned int l = 0; l < motions.size(); ++l)
          if (!motions[l].empty() && motions[l][i] != 0.)
            face_border_.add(layout.size() + l, layout.size() + m, motions[l][i] * force[i]);
      }
    }
    system.bulk.decouple(coupled);
    for (unsigned int i = 0; i < coupled.size(); ++i)
      if (coupled[i] != 0.)
        rhs.local_element(i) = 0.;
    model_.solid->forget_tangent();
  }
} // namespace Nodus
