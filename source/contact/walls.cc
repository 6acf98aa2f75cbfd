#include "contact/walls.h"
#include "contact/other_side.h"
#include "contact/surface.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace Nodus
{
  Vector wall_thickness(const ContactSurfaces &surfaces, const double faces)
  {
    const std::vector<Point> X      = surfaces.reference_positions();
    const MPI_Comm           comm   = surfaces.layout().communicator;
    const unsigned int       degree = surfaces.degree();
    std::vector<Vector3>     sum(X.size()), count(X.size()); // over the ranks that have faces at a node
    for (unsigned int p = 0; p < surfaces.n_pairs(); ++p)
    {
      if (!surfaces.touches_itself(p))
        continue;
      const double farthest = faces * surfaces.face_size(p);
      unsigned int n_bodies = 0;
      for (const SurfaceFace &face : surfaces.master_faces(p))
        n_bodies = std::max(n_bodies, face.body);
      n_bodies = dealii::Utilities::MPI::max(n_bodies, comm);
      for (unsigned int body = 1; body <= n_bodies; ++body) // what has come into a body is no end of its wall
      {
        std::vector<SurfaceFace> of_body;
        for (const SurfaceFace &face : surfaces.master_faces(p))
          if (face.body == body)
            of_body.push_back(face);
        if (dealii::Utilities::MPI::max(unsigned(of_body.size()), comm) == 0)
          continue;
        const Triangles triangles(
            of_body, dealii::Utilities::MPI::this_mpi_process(comm), degree, X, &surfaces.nodes());
        const OtherSide other(triangles, X, X, comm);

        // across every face at a node: the far side of a thin body ends where the node on its edge looks
        const std::set<unsigned int> own(triangles.nodes().begin(), triangles.nodes().end());
        std::vector<NodeQuestion>    questions;
        std::vector<unsigned int>    asked;
        for (const SurfaceFace &face : of_body)
          for (unsigned int i = 0; i < face.nodes.size(); ++i)
          {
            const unsigned int n = face.nodes[i];
            if (own.count(n) == 0)
              continue;
            const double  xi = double(i % (degree + 1)) / degree, eta = double(i / (degree + 1)) / degree;
            const Vector3 area = FaceGeometry(face, FaceShape(degree, xi, eta), X).area_vector();
            NodeQuestion  question{X[n], X[n], farthest, triangles.own_node(n)};
            question.own.outward = face.orientation / area.norm() * area;
            // what is nearer than the middle of the cell is another part of the body that touches
            question.own.least   = question.own.visible;
            question.own.visible = farthest;
            questions.push_back(question);
            asked.push_back(n);
          }
        for (const unsigned int n : own)
        {
          count[n][0] = 1.;
          sum[n][0]   = farthest;
        }
        const std::vector<NodeAnswer> answers = other.answers(questions);
        for (unsigned int i = 0; i < answers.size(); ++i)
          sum[asked[i]][0] = std::min(sum[asked[i]][0], answers[i].distance);
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
