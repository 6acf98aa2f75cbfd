#include "contact/walls.h"
#include "contact/other_side.h"
#include "contact/surface.h"

#include <algorithm>
#include <cmath>

namespace Nodus
{
  Vector wall_thickness(const ContactSurfaces &surfaces, const double faces)
  {
    const std::vector<Point> X    = surfaces.reference_positions();
    const MPI_Comm           comm = surfaces.layout().communicator;
    std::vector<Vector3>     sum(X.size()), count(X.size()); // over the ranks that have faces at a node
    for (unsigned int p = 0; p < surfaces.n_pairs(); ++p)
    {
      if (!surfaces.touches_itself(p))
        continue;
      const Triangles triangles(surfaces.slave_faces(p),
                                dealii::Utilities::MPI::this_mpi_process(comm),
                                surfaces.degree(),
                                X,
                                &surfaces.nodes());
      const OtherSide other(triangles, X, X, comm);
      const double    farthest = faces * surfaces.face_size(p);

      std::vector<NodeQuestion> questions;
      for (const unsigned int n : triangles.nodes())
      {
        questions.push_back({X[n], X[n], farthest, triangles.own_node(n)});
        // what is nearer than the middle of the cell is another body that touches
        questions.back().own.least   = questions.back().own.visible;
        questions.back().own.visible = farthest;
      }
      const std::vector<NodeAnswer> answers = other.answers(questions);
      for (unsigned int i = 0; i < answers.size(); ++i)
      {
        const unsigned int n = triangles.nodes()[i];
        count[n][0]          = 1.;
        sum[n][0]            = std::min(answers[i].distance, farthest);
      }
    }
    Vector walls, ranks;
    walls.reinit(surfaces.layout().owned[0], comm);
    ranks.reinit(surfaces.layout().owned[0], comm);
    surfaces.add(sum, walls);
    surfaces.add(count, ranks);
    for (const auto i : surfaces.layout().owned[0])
      if (ranks(i) > 0.)
        walls(i) /= ranks(i);
    walls.compress(dealii::VectorOperation::insert);
    return walls;
  }
} // namespace Nodus
