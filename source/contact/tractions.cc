#include <nodus/contact/tractions.h>

#include <algorithm>

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
    std::vector<Around> gather(const ContactSurfaces &surfaces,
                               const SurfaceWeights  &weights,
                               const Status          &status,
                               const ContactResidual &residual)
    {
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
        add(node.ledger, status.ledger(site));
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
    std::vector<ContactFields> all(pairs.size());
    std::vector<unsigned int>  local_number(surfaces.slave_nodes().size());
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      all[p].name   = pairs[p].name;
      all[p].degree = surfaces.degree();
    }
    const std::vector<Around> nodes = gather(surfaces, weights, status, residual);
    for (unsigned int k = 0; k < surfaces.slave_nodes().size(); ++k)
    {
      const SlaveNode   &slave  = surfaces.slave_nodes()[k];
      const SitePairing &frame  = pairing[k];
      ContactFields     &fields = all[slave.pair];
      local_number[k]           = fields.X.size();

      const Point  &X        = surfaces.nodes()[slave.node].X;
      const Vector3 traction = -nodes[k].force / weights.area()[k];
      const Vector3 friction = traction - (traction * frame.normal) * frame.normal;
      fields.X.push_back(X);
      fields.displacement.push_back(state.x[slave.node] - X);
      fields.pressure.push_back(-(traction * frame.normal));
      fields.multiplier.push_back(state.lambda[k]);
      fields.gap.push_back(frame.found ? -assembler.distance(state, k) : 0.);
      fields.friction.push_back(friction);
      for (unsigned int i = 0; i < 2; ++i)
      {
        fields.shear[i].push_back(friction * frame.tangent[i]);
        fields.slip[i].push_back(status.accumulated_slip(k)[i]);
      }
      fields.status.push_back(nodes[k].status());
      fields.normal.push_back(frame.normal);
      fields.tangent1.push_back(frame.tangent[0]);
      fields.area.push_back(weights.area()[k]);
      fields.paired.push_back(frame.found);
      fields.status_changes.push_back(nodes[k].ledger.changes);
      fields.cycle_period.push_back(nodes[k].ledger.period);
      fields.contradiction.push_back(static_cast<char>(nodes[k].ledger.last));
    }
    for (unsigned int p = 0; p < pairs.size(); ++p)
      for (const SurfaceFace &face : surfaces.slave_faces(p))
      {
        std::vector<unsigned int> nodes;
        for (const unsigned int i : face.nodes)
          nodes.push_back(local_number[surfaces.slave_number(i)]);
        all[p].faces.push_back(std::move(nodes));
        all[p].face_owner.push_back(face.owner);
      }
    return all;
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
      all[p].name = pairs[p].name;
    for (unsigned int i = 0; i < surfaces.n_sites(); ++i)
    {
      ContactResultants &result = all[surfaces.pair(i)];
      for (auto e = jump.begin(i); e != jump.end(i); ++e)
      {
        // the residual is minus the force on the body
        const bool    slave  = e < jump.middle(i);
        const Vector3 force  = -e->weight * residual.jump[i];
        const Vector3 moment = dealii::cross_product_3d(Vector3(state.x[e->node]), force);
        (slave ? result.slave_force : result.master_force) += force;
        (slave ? result.slave_moment : result.master_moment) += moment;
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
      if (point.site != dealii::numbers::invalid_unsigned_int && status.contact(point.site))
        all[surfaces.pair(point.site)].contact_area += point.weight;
    const std::vector<Around> nodes = gather(surfaces, weights, status, residual);
    for (unsigned int k = 0; k < nodes.size(); ++k)
    {
      ContactResultants &result = all[surfaces.pair(k)];
      if (nodes[k].status() == ContactStatus::open)
        continue;
      if (surfaces.has_status(k))
        result.contact_area += weights.area()[k];
      result.maximum_pressure =
          std::max(result.maximum_pressure, nodes[k].force * pairing[k].normal / weights.area()[k]);
    }
    return all;
  }
} // namespace Nodus
