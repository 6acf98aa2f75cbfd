#include "contact/pair_scales.h"
#include "output/diagnosis/suspected_causes.h"

// Contact surfaces that go into each other although all contact laws hold: what the slave cannot see.

namespace Nodus
{
  namespace Suspects
  {
    namespace
    {
      /// Slave faces that are so many times as large as those of the master do not see what is between their points.
      constexpr double coarser = 1.5;

      /// One body with faces that may be either side, and whose keys say all of them.
      bool can_change_sides(const Parameters &parameters, const RegionParameters &side)
      {
        return side.bodies.size() == 1 && side.ids_of_body.empty() && !parameters.bodies[side.first_body() - 1].rigid;
      }

      bool can_be_exchanged(const Parameters &parameters, const unsigned int pair)
      {
        const ContactPairParameters &keys = parameters.contact_pairs[pair];
        return !keys.self_contact && !keys.has_rigid_master() && can_change_sides(parameters, keys.slave) &&
               can_change_sides(parameters, keys.master);
      }

      SuspectedCause::Change exchange(const Parameters &parameters, const unsigned int pair, const std::string &reason)
      {
        const RegionParameters &slave  = parameters.contact_pairs[pair].slave,
                               &master = parameters.contact_pairs[pair].master;
        return {in_pair(pair, "Slave body"),
                slave.body_numbers(),
                master.body_numbers(),
                "slave and master are exchanged: " + reason,
                {{"Slave boundary ids", master.ids_text()},
                 {"Slave where", master.where},
                 {"Master body", slave.body_numbers()},
                 {"Master boundary ids", slave.ids_text()},
                 {"Master where", slave.where}}};
      }
    } // namespace

    void add_coarse_slave(const Parameters &parameters, const FailureEvidence &evidence, Causes &causes)
    {
      for (unsigned int p = 0; p < evidence.pairs.size(); ++p)
      {
        const auto &pair     = evidence.pairs[p];
        const auto &keys     = parameters.contact_pairs[p];
        const bool  averaged = keys.scheme == ContactPairParameters::Scheme::averaged;
        const bool  exact    = averaged && keys.integration == ContactPairParameters::Integration::segment;
        if (pair.face_size <= coarser * pair.master_face_size || exact)
          continue;
        // a scheme that brings its own weights refuses others
        std::vector<std::pair<std::string, std::string>> own_weights;
        if (keys.weights != ContactPairParameters::Weights::nodal_quadrature)
          own_weights.emplace_back("Weights", "nodal quadrature");
        causes.push_back({"the master has finer faces than the slave",
                          {text(pair_name(parameters, p),
                                ": mean slave face ",
                                pair.face_size,
                                ", mean master face ",
                                pair.master_face_size,
                                "; gaps are taken at points of the slave faces, and what is between these is not seen"),
                           evidence.message},
                          {{in_pair(p, averaged ? "Integration" : "Scheme"),
                            averaged ? text_of(keys.integration) : text_of(keys.scheme),
                            averaged ? "segment" : "averaged",
                            "gaps are integrated over the overlaps of the faces; or exchange slave and master",
                            own_weights}}});
      }
    }

    void add_edge_between_nodes(const Parameters &parameters, const FailureEvidence &evidence, Causes &causes)
    {
      SuspectedCause cause{
          "an edge or a corner of one surface goes in between the nodes of the other one", {evidence.message}, {}};
      for (unsigned int p = 0; p < evidence.pairs.size(); ++p)
        if (evidence.pairs[p].intruded && can_be_exchanged(parameters, p))
          cause.changes.push_back(exchange(parameters,
                                           p,
                                           "nodes of the slave are where its edges press, those of the master are not "
                                           "seen between these"));
      if (!cause.changes.empty())
        causes.push_back(cause);
    }

    void add_stiff_slave(const Parameters &parameters, const FailureEvidence &evidence, Causes &causes)
    {
      SuspectedCause cause{"the slave is much stiffer than its master", {}, {}};
      for (unsigned int p = 0; p < evidence.pairs.size(); ++p)
        if (const double ratio = evidence.pairs[p].slave_over_master;
            ratio >= much_stiffer && can_be_exchanged(parameters, p))
        {
          cause.evidence.push_back(text(pair_name(parameters, p),
                                        ": Young's modulus of the slave is ",
                                        ratio,
                                        " times that of the master, which cannot follow each node of it: few nodes "
                                        "carry the force, and small motions change which ones"));
          cause.changes.push_back(exchange(parameters, p, "the softer side as slave, whose nodes all find support"));
        }
      if (!cause.changes.empty())
        causes.push_back(cause);
    }
  } // namespace Suspects
} // namespace Nodus
