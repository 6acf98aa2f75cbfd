#include <nodus/contact/jump_operator.h>

namespace Nodus
{
  void JumpOperator::build_nodal(const ContactSurfaces &surfaces, const Pairing &pairing)
  {
    const auto &slaves = surfaces.slave_nodes();
    entries_.clear();
    start_.assign(1, 0);
    for (unsigned int k = 0; k < slaves.size(); ++k)
    {
      if (pairing[k].found)
      {
        const SurfaceFace &face = surfaces.master_faces(slaves[k].pair)[pairing[k].face];
        const FaceShape    shape(surfaces.degree(), pairing[k].xi, pairing[k].eta);
        entries_.push_back({slaves[k].node, 1.});
        for (unsigned int n = 0; n < face.nodes.size(); ++n)
          if (std::abs(shape.value[n]) > 1e-15)
            entries_.push_back({face.nodes[n], -shape.value[n]});
      }
      start_.push_back(entries_.size());
    }
  }
} // namespace Nodus
