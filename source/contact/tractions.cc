#include "contact/tractions.h"
#include "parallel/all_gather.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace Nodus
{
  namespace
  {
    /// What the integration points around a slave node say together.
    struct Around
    {
      Vector3      force;                            ///< conjugate to the node's displacement
      double       open = 0., slip = 0., stick = 0.; ///< areas, for the status of most of the surface
      StatusLedger ledger;

      ContactStatus status() const
      {
        return open >= slip + stick ? ContactStatus::open : stick >= slip ? ContactStatus::stick : ContactStatus::slip;
      }
    };

    void add(StatusLedger &sum, const StatusLedger &ledger)
    {
      sum.changes += ledger.changes;
      sum.period = std::max(sum.period, ledger.period);
      sum.last   = std::max(sum.last, ledger.last);
    }

    /// Slave nodes speak for themselves; those of the integration point scheme gather from the points of their faces.
    /// Right at own nodes. Collective.
    std::vector<Around> gather(const ContactSurfaces &surfaces,
                               const SurfaceWeights  &weights,
                               const Status          &status,
                               const ContactResidual &residual)
    {
      std::vector<StatusLedger> ledger;
      for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
        ledger.push_back(status.ledger(s));
      surfaces.site_exchange().update(ledger);
      std::vector<Around> nodes(surfaces.slave_nodes().size());
      const auto          count = [&](Around &node, const unsigned int site, const double area)
      {
        switch (status.status(site))
        {
          case ContactStatus::open:
            node.open += area;
            break;
          case ContactStatus::slip:
            node.slip += area;
            break;
          case ContactStatus::stick:
            node.stick += area;
            break;
        }
        add(node.ledger, ledger[site]);
      };
      for (unsigned int k = 0; k < nodes.size(); ++k)
        if (surfaces.has_status(k))
        {
          nodes[k].force = residual.jump[k];
          count(nodes[k], k, 1.);
        }
      for (const ContactPoint &point : weights.points())
        if (point.site != dealii::numbers::invalid_unsigned_int)
          for (unsigned int a = 0; a < point.slaves.size(); ++a)
          {
            nodes[point.slaves[a]].force += point.shape[a] * residual.jump[point.site];
            count(nodes[point.slaves[a]], point.site, point.weight * std::abs(point.shape[a]));
          }
      return nodes;
    }

    /// Results of a slave node as sent to the ranks that have it as a ghost.
    struct NodeResult
    {
      double        pressure, gap, friction[dim], shear[2], slip[2];
      ContactStatus status;
      StatusLedger  ledger;
    };

    void sum_over_ranks(ContactResultants &result, const MPI_Comm communicator)
    {
      std::vector<Vector3 *> vectors = {
          &result.slave_force, &result.slave_moment, &result.master_force, &result.master_moment, &result.friction};
      for (auto &master : result.masters)
        vectors.insert(vectors.end(), {&master.force, &master.moment});
      unsigned int *const counts[] = {&result.open,
                                      &result.slip,
                                      &result.stick,
                                      &result.unpaired,
                                      &result.status_changes,
                                      &result.contradictions[0],
                                      &result.contradictions[1],
                                      &result.contradictions[2],
                                      &result.contradictions[3]};
      std::vector<double> sums;
      for (const Vector3 *const v : vectors)
        sums.insert(sums.end(), &(*v)[0], &(*v)[0] + dim);
      for (const unsigned int *const n : counts)
        sums.push_back(*n);
      sums.push_back(result.contact_area);
      dealii::Utilities::MPI::sum(sums, communicator, sums);
      auto sum = sums.begin();
      for (Vector3 *const v : vectors)
        for (unsigned int c = 0; c < dim; ++c)
          (*v)[c] = *sum++;
      for (unsigned int *const n : counts)
        *n = static_cast<unsigned int>(*sum++);
      result.contact_area     = *sum;
      result.maximum_pressure = dealii::Utilities::MPI::max(result.maximum_pressure, communicator);
      result.longest_cycle    = dealii::Utilities::MPI::max(result.longest_cycle, communicator);
    }

    NodeResult node_result(const Around                &around,
                           const SitePairing           &frame,
                           const double                 area,
                           const double                 gap,
                           const std::array<double, 2> &slip)
    {
      const Vector3 traction = -around.force / area;
      const Vector3 friction = traction - (traction * frame.normal) * frame.normal;
      NodeResult    result{};
      result.pressure = -(traction * frame.normal);
      result.gap      = gap;
      for (unsigned int c = 0; c < dim; ++c)
        result.friction[c] = friction[c];
      for (unsigned int i = 0; i < 2; ++i)
      {
        result.shear[i] = friction * frame.tangent[i];
        result.slip[i]  = slip[i];
      }
      result.status = around.status();
      result.ledger = around.ledger;
      return result;
    }

    /// Adds slave node @p k to the fields of its pair.
    void add_slave_node(const unsigned int     k,
                        const ContactSurfaces &surfaces,
                        const SitePairing     &frame,
                        const double           area,
                        const NodeResult      &result,
                        const ContactState    &state,
                        ContactFields         &fields)
    {
      const SlaveNode &slave = surfaces.slave_nodes()[k];
      const Point     &X     = surfaces.nodes()[slave.node].X;
      fields.X.push_back(X);
      fields.displacement.push_back(state.x[slave.node] - X);
      if (const unsigned int section = surfaces.section(slave.pair); section != dealii::numbers::invalid_unsigned_int)
        fields.displacement.back() += state.shortening[section];
      fields.pressure.push_back(result.pressure);
      fields.multiplier.push_back(state.lambda[k]);
      fields.gap.push_back(result.gap);
      fields.friction.push_back(Vector3(result.friction));
      for (unsigned int i = 0; i < 2; ++i)
      {
        fields.shear[i].push_back(result.shear[i]);
        fields.slip[i].push_back(result.slip[i]);
      }
      fields.status.push_back(result.status);
      fields.normal.push_back(frame.normal);
      fields.tangent1.push_back(frame.tangent[0]);
      fields.area.push_back(area);
      fields.paired.push_back(frame.found);
      fields.status_changes.push_back(result.ledger.changes);
      fields.cycle_period.push_back(result.ledger.period);
      fields.contradiction.push_back(static_cast<char>(result.ledger.last));
      fields.number.push_back(surfaces.multiplier(k));
      fields.node.push_back(surfaces.nodes()[slave.node].dofs[0] / dim);
    }

    /// Adds node @p n of a face, which hangs, to the fields, with what the slave nodes that it follows give it.
    /// @returns its place.
    unsigned int add_hanging_node(const unsigned int               n,
                                  const SurfaceFace               &face,
                                  const ContactSurfaces           &surfaces,
                                  const std::vector<Point>        &x,
                                  const std::vector<unsigned int> &place_of_slave,
                                  ContactFields                   &fields)
    {
      std::vector<std::pair<unsigned int, double>> shares;
      for (unsigned int j = 0; j < face.slaves.size(); ++j)
        if (const double share = face.basis[n * face.slaves.size() + j]; share != 0.)
          shares.emplace_back(place_of_slave[face.slaves[j]], share);
      const unsigned int node   = face.nodes[n];
      const SurfaceNode &hung   = surfaces.nodes()[node];
      const unsigned int place  = fields.X.size();
      const DoFIndex     number = hung.dofs[0] / dim;
      fields.interpolate(shares, hung.X, x[node] - hung.X, surfaces.layout().n_slave_nodes + number, number);
      return place;
    }

    /// Adds this rank's slave faces of a pair, and their hanging nodes.
    void add_faces(const unsigned int               pair,
                   const ContactSurfaces           &surfaces,
                   const std::vector<Point>        &x,
                   const std::vector<unsigned int> &place_of_slave,
                   ContactFields                   &fields)
    {
      const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(surfaces.layout().communicator);
      std::map<unsigned int, unsigned int> place_of_hanging;
      for (const SurfaceFace &face : surfaces.slave_faces(pair))
      {
        if (face.owner != rank)
          continue;
        std::vector<unsigned int> places;
        for (unsigned int n = 0; n < face.nodes.size(); ++n)
        {
          const unsigned int node = face.nodes[n], k = surfaces.slave_number(pair, node);
          if (k != dealii::numbers::invalid_unsigned_int)
            places.push_back(place_of_slave[k]);
          else
          {
            const auto [place, is_new] = place_of_hanging.emplace(node, 0);
            if (is_new)
              place->second = add_hanging_node(n, face, surfaces, x, place_of_slave, fields);
            places.push_back(place->second);
          }
        }
        fields.faces.push_back(std::move(places));
      }
    }
  } // namespace

  std::vector<ContactFields> contact_fields(const std::vector<ContactPairParameters> &pairs,
                                            const ContactSurfaces                    &surfaces,
                                            const Pairing                            &pairing,
                                            const SurfaceWeights                     &weights,
                                            const Status                             &status,
                                            const ContactAssembler                   &assembler,
                                            const ContactState                       &state,
                                            const ContactResidual                    &residual)
  {
    const std::vector<Around> around = gather(surfaces, weights, status, residual);
    std::vector<NodeResult>   results(surfaces.slave_nodes().size());
    for (unsigned int k = 0; k < surfaces.n_owned_slave_nodes(); ++k)
    {
      const double gap = pairing[k].found ? -assembler.distance(state, k) : 0.;
      results[k]       = node_result(around[k], pairing[k], weights.area()[k], gap, status.accumulated_slip(k));
    }
    surfaces.slave_exchange().update(results);

    std::vector<ContactFields> all(pairs.size());
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      all[p].name   = pairs[p].name;
      all[p].degree = surfaces.degree();
    }
    std::vector<unsigned int> place_of_slave;
    for (unsigned int k = 0; k < results.size(); ++k)
    {
      ContactFields &fields = all[surfaces.pair(k)];
      place_of_slave.push_back(fields.X.size());
      add_slave_node(k, surfaces, pairing[k], weights.area()[k], results[k], state, fields);
    }
    for (unsigned int p = 0; p < pairs.size(); ++p)
      add_faces(p, surfaces, state.x, place_of_slave, all[p]);
    return all;
  }

  std::vector<ContactFields> whole_surface(const std::vector<ContactFields> &parts, const MPI_Comm communicator)
  {
    std::vector<ContactFields> whole;
    for (const ContactFields &part : parts)
    {
      const auto all = all_gather(communicator, part);
      // nodes on several ranks are the same there: the first one counts
      std::map<DoFIndex, std::pair<unsigned int, unsigned int>> nodes; // by number: rank and place
      for (unsigned int r = 0; r < all.size(); ++r)
        for (unsigned int i = 0; i < all[r].number.size(); ++i)
          nodes.emplace(all[r].number[i], std::make_pair(r, i));

      ContactFields                    surface;
      std::map<DoFIndex, unsigned int> place;
      surface.name   = part.name;
      surface.degree = part.degree;
      for (const auto &[number, source] : nodes)
      {
        place[number] = place.size();
        surface.append(all[source.first], source.second);
      }
      for (const ContactFields &piece : all)
        for (const auto &face : piece.faces)
        {
          surface.faces.emplace_back();
          for (const unsigned int i : face)
            surface.faces.back().push_back(place.at(piece.number[i]));
        }
      whole.push_back(std::move(surface));
    }
    return whole;
  }

  std::vector<ContactResultants> contact_resultants(const std::vector<ContactPairParameters> &pairs,
                                                    const ContactSurfaces                    &surfaces,
                                                    const Pairing                            &pairing,
                                                    const JumpOperator                       &jump,
                                                    const SurfaceWeights                     &weights,
                                                    const Status                             &status,
                                                    const ContactState                       &state,
                                                    const ContactResidual                    &residual)
  {
    std::vector<ContactResultants> all(pairs.size());
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      all[p].name = pairs[p].name;
      if (pairs[p].master.bodies.size() > 1 && !pairs[p].self_contact)
        for (const unsigned int body : pairs[p].master.bodies)
          all[p].masters.push_back({body, Vector3(), Vector3()});
    }
    for (unsigned int i = 0; i < surfaces.n_sites(); ++i)
    {
      if (!surfaces.is_owned(i))
        continue;
      ContactResultants &result = all[surfaces.pair(i)];
      for (const Vector3 &tangent : pairing[i].tangent)
        result.friction -= (residual.jump[i] * tangent) * tangent;
      for (auto e = jump.begin(i); e != jump.end(i); ++e)
      {
        // the residual is minus the force on the body
        const bool    slave  = e < jump.middle(i);
        const Vector3 force  = -jump.force(i, *e, residual.jump[i]);
        const Vector3 moment = dealii::cross_product_3d(Vector3(state.x[e->node]), force);
        (slave ? result.slave_force : result.master_force) += force;
        (slave ? result.slave_moment : result.master_moment) += moment;
        for (auto &master : result.masters)
          if (!slave && master.body == surfaces.nodes()[e->node].body)
          {
            master.force += force;
            master.moment += moment;
          }
      }
      const RigidSurface *const rigid = surfaces.rigid_master(surfaces.pair(i));
      if (rigid != nullptr && rigid->carrier() == nullptr)
      {
        result.master_force += residual.jump[i];
        result.master_moment += dealii::cross_product_3d(jump.rigid(i).x, residual.jump[i]);
      }
      if (!surfaces.has_status(i))
        continue;
      const StatusLedger &ledger = status.ledger(i);
      result.status_changes += ledger.changes;
      if (ledger.last != Contradiction::none)
        ++result.contradictions[static_cast<unsigned int>(ledger.last) - 1];
      result.longest_cycle = std::max(result.longest_cycle, ledger.period);
      result.unpaired += !pairing[i].found;
      switch (status.status(i))
      {
        case ContactStatus::open:
          ++result.open;
          break;
        case ContactStatus::slip:
          ++result.slip;
          break;
        case ContactStatus::stick:
          ++result.stick;
          break;
      }
    }
    for (const ContactPoint &point : weights.points())
      if (surfaces.is_owned(point.site) && status.contact(point.site))
        all[surfaces.pair(point.site)].contact_area += point.weight;
    const std::vector<Around> nodes = gather(surfaces, weights, status, residual);
    for (unsigned int k = 0; k < surfaces.n_owned_slave_nodes(); ++k)
    {
      ContactResultants &result = all[surfaces.pair(k)];
      if (nodes[k].status() == ContactStatus::open)
        continue;
      if (surfaces.has_status(k))
        result.contact_area += weights.area()[k];
      result.maximum_pressure =
          std::max(result.maximum_pressure, nodes[k].force * pairing[k].normal / weights.area()[k]);
    }
    for (ContactResultants &result : all)
      sum_over_ranks(result, surfaces.layout().communicator);
    return all;
  }
} // namespace Nodus
