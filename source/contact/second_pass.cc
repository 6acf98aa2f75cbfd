#include "contact/second_pass.h"
#include "contact/surface.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Nodus
{
  namespace
  {
    /// Whether a master node of the pair, or one that a hanging one follows, has multipliers. Collective.
    bool has_slaves_on_master(const ContactSurfaces &surfaces, const unsigned int pair)
    {
      const MPI_Comm communicator = surfaces.layout().communicator;
      Vector         slaves(surfaces.layout().owned[0], communicator);
      for (unsigned int k = 0; k < surfaces.n_owned_slave_nodes(); ++k)
        slaves(surfaces.nodes()[surfaces.slave_nodes()[k].node].dofs[0]) = 1.;
      slaves.compress(dealii::VectorOperation::insert);
      std::vector<Vector3> at_nodes;
      surfaces.gather(slaves, at_nodes);
      bool found = false;
      for (const SurfaceFace &face : surfaces.master_faces(pair))
        for (const unsigned int n : face.nodes)
          surfaces.expand(
              n, 1., [&](const unsigned int node, double) { found = found || at_nodes[node] != Vector3(); });
      return dealii::Utilities::MPI::logical_or(found, communicator);
    }
  } // namespace

  bool may_have_second_pass(const Parameters &parameters, const ContactSurfaces &surfaces, const unsigned int pair)
  {
    const std::vector<ContactPairParameters> &pairs = parameters.contact_pairs;
    const ContactPairParameters              &first = pairs[pair];
    const auto is_rigid = [&](const unsigned int body) { return parameters.bodies[body - 1].rigid; };
    if (first.second_pass || first.self_contact || first.has_rigid_master() ||
        first.contact_law != ContactPairParameters::ContactLaw::unilateral ||
        std::any_of(first.master.bodies.begin(), first.master.bodies.end(), is_rigid) ||
        std::any_of(
            pairs.begin(), pairs.end(), [&](const auto &p) { return p.second_pass && p.second_pass->of == pair; }))
      return false;
    return !has_slaves_on_master(surfaces, pair);
  }

  ContactPairParameters
  second_pass(const std::vector<ContactPairParameters> &pairs, const unsigned int pair, const double clearance)
  {
    const ContactPairParameters &first  = pairs[pair];
    ContactPairParameters        second = first;
    second.name        = (first.name.empty() ? "pair " + std::to_string(pair + 1) : first.name) + ", second pass";
    second.slave       = first.master;
    second.master      = first.slave;
    second.scheme      = ContactPairParameters::Scheme::nodal;
    second.weights     = ContactPairParameters::Weights::nodal_quadrature;
    second.start       = ContactPairParameters::Start();
    second.second_pass = {pair, clearance};
    if (first.friction_law != ContactPairParameters::FrictionLaw::coulomb || first.shear_limit > 0.)
    {
      second.friction_law         = ContactPairParameters::FrictionLaw::coulomb;
      second.friction_coefficient = second.second_friction_coefficient = second.shear_limit = second.elastic_slip = 0.;
      second.friction_factor                                                                                      = "1";
      second.own_friction_law                                                                                     = {};
    }
    return second;
  }

  unsigned int given_pair(const std::vector<ContactPairParameters> &pairs, const unsigned int pair)
  {
    return pairs[pair].second_pass ? pairs[pair].second_pass->of : pair;
  }
} // namespace Nodus
