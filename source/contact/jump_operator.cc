#include <nodus/contact/jump_operator.h>

#include <algorithm>
#include <cmath>

namespace Nodus
{
  void JumpOperator::build(const std::vector<ContactPairParameters> &pairs,
                           const ContactSurfaces                    &surfaces,
                           const ContactGeometry                    &geometry,
                           const Pairing                            &pairing,
                           const AveragedJump                       &averaged)
  {
    entries_.clear();
    start_.assign(1, 0);
    middle_.clear();
    offset_.clear();
    std::size_t first_of_part = 0; // slave or master part of a row
    // a hanging node is where those are that it follows, but for its reference position
    const auto add = [&](const unsigned int node, const double weight)
    {
      surfaces.expand(node,
                      weight,
                      [&](const unsigned int free_node, const double part)
                      {
                        const auto at = std::find_if(entries_.begin() + first_of_part,
                                                     entries_.end(),
                                                     [&](const Entry &e) { return e.node == free_node; });
                        if (at == entries_.end())
                          entries_.push_back({free_node, part});
                        else
                          at->weight += part;
                      });
      offset_.back() += weight * surfaces.nodes()[node].offset;
    };
    rigid_.assign(surfaces.n_sites(), RigidPart());
    const auto add_shape = [&](const SurfaceFace &face, const FaceShape &shape, const double sign)
    {
      for (unsigned int n = 0; n < shape.n; ++n)
        if (std::abs(shape.value[n]) > 1e-15)
          add(face.nodes[n], sign * shape.value[n]);
    };
    for (unsigned int s = 0; s < surfaces.n_sites(); ++s)
    {
      const unsigned int p        = surfaces.pair(s);
      const bool         averages = pairs[p].scheme == ContactPairParameters::Scheme::averaged;
      const Projection  &master   = pairing[s].master;
      middle_.push_back(entries_.size());
      first_of_part = entries_.size();
      offset_.emplace_back();
      if (pairing[s].found && averages)
      {
        const AveragedJump::Row &row = averaged.row(s);
        entries_.insert(entries_.end(), row.slave.begin(), row.slave.end());
        middle_.back() = entries_.size();
        entries_.insert(entries_.end(), row.master.begin(), row.master.end());
        rigid_[s]      = row.rigid;
        offset_.back() = row.offset - row.rigid.x;
      }
      else if (pairing[s].found && (master.found() || geometry.rigid[p] != nullptr))
      {
        if (geometry.rigid[p] != nullptr)
        {
          const RigidPoint point = geometry.rigid[p]->closest(geometry.position(surfaces, s));
          rigid_[s]              = {point.x, geometry.rigid[p]->moved(point.x)};
          offset_.back()         = -rigid_[s].x;
        }
        else
          offset_.back() = -geometry.master[p].offset(master.face, master.xi, master.eta);
        if (surfaces.is_point(s))
        {
          const SlavePoint &point = surfaces.point(s);
          add_shape(geometry.slave[p].face(point.face), FaceShape(surfaces.degree(), point.xi, point.eta), 1.);
          offset_.back() += geometry.slave[p].offset(point.face, point.xi, point.eta);
        }
        else
          entries_.push_back({surfaces.slave_nodes()[s].node, 1.});
        middle_.back() = first_of_part = entries_.size();
        if (master.found())
          add_shape(geometry.master[p].face(master.face), FaceShape(surfaces.degree(), master.xi, master.eta), -1.);
      }
      start_.push_back(entries_.size());
    }
  }
} // namespace Nodus
