#include <nodus/contact/tractions.h>

#include <algorithm>

namespace Nodus
{
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
    for (unsigned int k = 0; k < surfaces.slave_nodes().size(); ++k)
    {
      const SlaveNode   &slave  = surfaces.slave_nodes()[k];
      const NodePairing &frame  = pairing[k];
      ContactFields     &fields = all[slave.pair];
      local_number[k]           = fields.X.size();

      const Point  &X        = surfaces.nodes()[slave.node].X;
      const Vector3 traction = -residual.jump[k] / weights.area()[k];
      const Vector3 friction = traction - (traction * frame.normal) * frame.normal;
      fields.X.push_back(X);
      fields.displacement.push_back(state.x[slave.node] - X);
      fields.pressure.push_back(-(traction * frame.normal));
      fields.gap.push_back(frame.found ? -assembler.distance(state, k) : 0.);
      fields.friction.push_back(friction);
      for (unsigned int i = 0; i < 2; ++i)
      {
        fields.shear[i].push_back(friction * frame.tangent[i]);
        fields.slip[i].push_back(status.accumulated_slip(k)[i]);
      }
      fields.status.push_back(status.status(k));
      fields.normal.push_back(frame.normal);
      fields.tangent1.push_back(frame.tangent[0]);
      fields.area.push_back(weights.area()[k]);
      fields.paired.push_back(frame.found);
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
    for (unsigned int k = 0; k < surfaces.slave_nodes().size(); ++k)
    {
      const SlaveNode   &slave  = surfaces.slave_nodes()[k];
      ContactResultants &result = all[slave.pair];
      for (auto e = jump.begin(k); e != jump.end(k); ++e)
      {
        // the residual is minus the force on the body
        const Vector3 force  = -e->weight * residual.jump[k];
        const Vector3 moment = dealii::cross_product_3d(Vector3(state.x[e->node]), force);
        if (e->node == slave.node)
        {
          result.slave_force += force;
          result.slave_moment += moment;
        }
        else
        {
          result.master_force += force;
          result.master_moment += moment;
        }
      }
      result.unpaired += !pairing[k].found;
      switch (status.status(k))
      {
        case ContactStatus::open:
          ++result.open;
          continue;
        case ContactStatus::slip:
          ++result.slip;
          break;
        case ContactStatus::stick:
          ++result.stick;
          break;
      }
      result.contact_area += weights.area()[k];
      result.maximum_pressure =
          std::max(result.maximum_pressure, residual.jump[k] * pairing[k].normal / weights.area()[k]);
    }
    return all;
  }
} // namespace Nodus
